/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/history.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/mem.h"
#include "io/atomic_file.h"

enum { LINE_BYTES = PW_RECORD_MAX * 72 };

struct pw_history {
  int fd;
  pw_off size; /* bytes of whole rows */
  char path[PW_PATH];
  char header[LINE_BYTES]; /* the first line, newline included */
  char line[LINE_BYTES];
};

static pw_status check_names(const pw_record *row)
{
  PW_REQUIRE(row->n >= 2 && strcmp(row->item[0].name, "time_s") == 0 &&
                 strcmp(row->item[1].name, "step") == 0,
             PW_ERR_ARGUMENT, "the first two columns of a history are time_s and step");
  for (int i = 0; i < row->n; i++) {
    PW_REQUIRE(!row->item[i].array, PW_ERR_ARGUMENT, "%s is a list, not a column of a history",
               row->item[i].name);
  }
  return PW_OK;
}

/* Names have at most 63 characters and numbers fewer than 25: a line of PW_RECORD_MAX always
 * fits. */
static size_t header_line(const pw_record *row, char *line)
{
  size_t length = 0;
  for (int i = 0; i < row->n; i++) {
    length += (size_t)snprintf(line + length, LINE_BYTES - length, "%s%s", i ? "," : "",
                               row->item[i].name);
  }
  length += (size_t)snprintf(line + length, LINE_BYTES - length, "\n");
  return length;
}

static int put_number(char *text, size_t size, int column, pw_real value)
{
  if (isnan(value)) {
    return snprintf(text, size, "nan"); /* printf may add a sign */
  }
  /* adding zero shows -0 as 0 */
  return snprintf(text, size, "%.*g", column == 0 ? 12 : column == 1 ? 17 : 9, value + 0.0);
}

static size_t number_line(const pw_record *row, char *line)
{
  size_t length = 0;
  for (int i = 0; i < row->n; i++) {
    if (i > 0) {
      line[length++] = ',';
    }
    length += (size_t)put_number(line + length, LINE_BYTES - length, i, row->item[i].value);
  }
  line[length++] = '\n';
  return length;
}

static pw_status attach(pw_history *h)
{
  h->fd = open(h->path, O_WRONLY | O_APPEND);
  PW_REQUIRE(h->fd >= 0, PW_ERR_FILE, "cannot write %s: %s", h->path, strerror(errno));
  struct stat info;
  PW_REQUIRE(fstat(h->fd, &info) == 0, PW_ERR_FILE, "cannot write %s: %s", h->path,
             strerror(errno));
  h->size = info.st_size;
  return PW_OK;
}

static pw_status prepare(const char *path, const pw_record *header, pw_history **out)
{
  *out = NULL;
  PW_TRY(check_names(header));
  size_t length = strlen(path);
  PW_REQUIRE(length < PW_PATH, PW_ERR_FILE, "%s: the path is too long", path);
  PW_TRY(pw_mem_alloc("history", 1, sizeof **out, out));
  (*out)->fd = -1;
  memcpy((*out)->path, path, length + 1);
  header_line(header, (*out)->header);
  return PW_OK;
}

/* Close after a failure without touching the error record. */
static pw_status drop(pw_history **h, pw_status status)
{
  if (*h && (*h)->fd >= 0) {
    close((*h)->fd);
  }
  pw_mem_free(h);
  return status;
}

pw_status pw_history_open(const char *path, const pw_record *header, pw_history **out)
{
  PW_TRY(prepare(path, header, out));
  pw_status status = pw_atomic_write(path, (*out)->header, strlen((*out)->header));
  if (status == PW_OK) {
    status = attach(*out);
  }
  return status == PW_OK ? PW_OK : drop(out, status);
}

static pw_status read_text(const char *path, char **text, size_t *size)
{
  struct stat info;
  FILE *file = fopen(path, "rb");
  PW_REQUIRE(file, PW_ERR_FILE, "cannot read %s: %s", path, strerror(errno));
  pw_off bytes = fstat(fileno(file), &info) == 0 ? info.st_size : 0;
  pw_status status = pw_mem_alloc("history of the earlier run", bytes + 1, 1, text);
  if (status == PW_OK) {
    *size = fread(*text, 1, (size_t)bytes, file);
    if (ferror(file)) {
      pw_mem_free(text);
      status = pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__, "cannot read %s", path);
    }
  }
  fclose(file);
  return status;
}

/* Bytes of the rows up to @p step; rows are in order of steps, a last one without its newline is
 * not whole. */
static size_t rows_to_keep(const char *text, size_t start, pw_off step)
{
  size_t keep = start;
  for (const char *row = text + start, *end = strchr(row, '\n'); end;
       row = end + 1, end = strchr(row, '\n')) {
    const char *comma = memchr(row, ',', (size_t)(end - row));
    if (!comma || strtoll(comma + 1, NULL, 10) > step) {
      break;
    }
    keep = (size_t)(end + 1 - text);
  }
  return keep;
}

static pw_status cut(pw_history *h, pw_off step)
{
  char *text = NULL;
  size_t size = 0;
  PW_TRY(read_text(h->path, &text, &size));
  size_t names = strlen(h->header);
  pw_status status;
  if (size >= names && memcmp(text, h->header, names) == 0) {
    status = pw_atomic_write(h->path, text, rows_to_keep(text, names, step));
  } else {
    status = pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__,
                          "%s: its columns are not those of this scene", h->path);
  }
  pw_mem_free(&text);
  return status;
}

pw_status pw_history_resume(const char *path, const pw_record *header, pw_off step,
                            pw_history **out)
{
  if (access(path, F_OK) != 0) {
    return pw_history_open(path, header, out);
  }
  PW_TRY(prepare(path, header, out));
  pw_status status = cut(*out, step);
  if (status == PW_OK) {
    status = attach(*out);
  }
  return status == PW_OK ? PW_OK : drop(out, status);
}

pw_status pw_history_append(pw_history *h, const pw_record *row)
{
  PW_TRY(check_names(row));
  header_line(row, h->line);
  PW_REQUIRE(strcmp(h->line, h->header) == 0, PW_ERR_ARGUMENT,
             "%s: the names of a row differ from those of the first line", h->path);
  size_t length = number_line(row, h->line);
  ssize_t done;
  do {
    errno = 0;
    done = write(h->fd, h->line, length);
  } while (done < 0 && errno == EINTR);
  if (done != (ssize_t)length) {
    int reason = errno ? errno : ENOSPC; /* a short write means that the room has run out */
    if (done > 0 && ftruncate(h->fd, h->size) != 0) {
      reason = errno;
    }
    PW_REQUIRE(false, PW_ERR_FILE, "cannot write %s: %s", h->path, strerror(reason));
  }
  h->size += done;
  return PW_OK;
}

pw_status pw_history_sync(pw_history *h)
{
  PW_REQUIRE(fsync(h->fd) == 0, PW_ERR_FILE, "cannot write %s: %s", h->path, strerror(errno));
  return PW_OK;
}

pw_status pw_history_close(pw_history **h)
{
  pw_status status = PW_OK;
  if (*h && (*h)->fd >= 0 && close((*h)->fd) != 0) {
    status = pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__, "cannot write %s: %s",
                          (*h)->path, strerror(errno));
  }
  pw_mem_free(h);
  return status;
}
