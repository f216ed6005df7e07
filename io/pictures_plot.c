/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/pictures_plot.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MESSAGE = 256 };

static bool is_svg(const char *path)
{
  size_t n = strlen(path);
  return n > 4 && strcmp(path + n - 4, ".svg") == 0;
}

pw_status pw_plot_begin(const char *folder, const char *name, int width, int height, pw_plot *out)
{
  PW_TRY(pw_path_join(folder, name, out->path));
  PW_TRY(pw_atomic_temp(out->path, out->temp));
  PW_REQUIRE(snprintf(out->commands, PW_PATH, "%s.gp", out->path) < PW_PATH, PW_ERR_FILE,
             "%s: the path is too long", out->path);
  out->script = fopen(out->commands, "w");
  PW_REQUIRE(out->script, PW_ERR_FILE, "cannot write %s: %s", out->commands, strerror(errno));
  fprintf(out->script, "set terminal %s size %d,%d font 'DejaVu Sans,16' linewidth 1.5\n",
          is_svg(out->path) ? "svg" : "pngcairo", width, height);
  fprintf(out->script, "set output ");
  pw_plot_text(out, out->temp);
  fprintf(out->script, "\nset encoding utf8\n");
  return PW_OK;
}

/* Between single quotes nothing but the quote itself, doubled, is special. */
void pw_plot_text(pw_plot *plot, const char *text)
{
  fputc('\'', plot->script);
  for (; *text; text++) {
    if (*text == '\'') {
      fputc('\'', plot->script);
    }
    fputc(iscntrl((unsigned char)*text) ? ' ' : *text, plot->script);
  }
  fputc('\'', plot->script);
}

/* The child has no input, prints to nowhere and complains into @p message. Its script is a named
 * file: from standard input gnuplot reads byte by byte. */
static int start_gnuplot(const pw_plot *plot, int message, pid_t *child)
{
  char program[] = "gnuplot", defaults[] = "--default-settings", commands[PW_PATH];
  char *const words[] = {program, defaults, commands, NULL};
  memcpy(commands, plot->commands, sizeof commands);
  posix_spawn_file_actions_t actions;
  int error = posix_spawn_file_actions_init(&actions);
  if (error) {
    return error;
  }
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, message, STDERR_FILENO);
  error = posix_spawnp(child, "gnuplot", &actions, NULL, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

static bool wait_for(pid_t child)
{
  int state = 0;
  pid_t got;
  do {
    got = waitpid(child, &state, 0);
  } while (got < 0 && errno == EINTR);
  return got == child && WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

/* The last line gnuplot wrote is its reason; those before it repeat the input. */
static void last_line(FILE *file, char *text)
{
  char line[MESSAGE];
  text[0] = '\0';
  rewind(file);
  while (fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = '\0';
    if (line[strspn(line, " \t^")] != '\0') {
      memcpy(text, line, sizeof line);
    }
  }
}

static pw_status run_gnuplot(const pw_plot *plot, FILE *message)
{
  pid_t child;
  char reason[MESSAGE];
  int error = start_gnuplot(plot, fileno(message), &child);
  PW_REQUIRE(error != ENOENT, PW_ERR_UNSUPPORTED,
             "gnuplot was not found, no pictures (Debian package: gnuplot-nox)");
  PW_REQUIRE(error == 0, PW_ERR_FILE, "cannot start gnuplot: %s", strerror(error));
  bool good = wait_for(child);
  last_line(message, reason);
  PW_REQUIRE(good, PW_ERR_FILE, "gnuplot cannot draw %s: %s", plot->path, reason);
  return PW_OK;
}

/* A PNG file starts with its signature and ends with an empty IEND chunk (PNG specification,
 * sections 5.2 and 11.2.5); a disk that ran full leaves it without. */
static bool whole_png(const char *path)
{
  static const unsigned char head[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  static const unsigned char tail[8] = {'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
  unsigned char bytes[8];
  FILE *file = fopen(path, "rb");
  if (!file) {
    return false;
  }
  bool good = fread(bytes, 1, 8, file) == 8 && memcmp(bytes, head, 8) == 0 &&
              fseek(file, -8, SEEK_END) == 0 && fread(bytes, 1, 8, file) == 8 &&
              memcmp(bytes, tail, 8) == 0;
  fclose(file);
  return good;
}

/* An SVG file ends with the tag that closes it. */
static bool whole_svg(const char *path)
{
  char bytes[17] = "";
  FILE *file = fopen(path, "rb");
  if (!file) {
    return false;
  }
  bool good = fseek(file, -16, SEEK_END) == 0 && fread(bytes, 1, 16, file) == 16 &&
              strstr(bytes, "</svg>") != NULL;
  fclose(file);
  return good;
}

static pw_status draw(const pw_plot *plot)
{
  FILE *message = tmpfile();
  PW_REQUIRE(message, PW_ERR_FILE, "cannot make a temporary file for gnuplot: %s", strerror(errno));
  pw_status status = run_gnuplot(plot, message);
  fclose(message);
  PW_TRY(status);
  bool whole = is_svg(plot->path) ? whole_svg(plot->temp) : whole_png(plot->temp);
  PW_REQUIRE(whole, PW_ERR_FILE,
             "cannot write %s: gnuplot left an incomplete picture (no room on the disk?)",
             plot->path);
  return pw_atomic_commit(plot->temp, plot->path);
}

pw_status pw_plot_end(pw_plot *plot)
{
  fprintf(plot->script, "\nunset output\n");
  bool whole = !ferror(plot->script);
  whole = fclose(plot->script) == 0 && whole;
  plot->script = NULL;
  pw_status status = PW_OK;
  if (whole) {
    status = draw(plot);
  } else {
    status = pw_error_set(PW_ERR_FILE, __FILE__, __LINE__, __func__,
                          "cannot write %s (no room on the disk?)", plot->commands);
  }
  unlink(plot->commands);
  if (status != PW_OK) {
    unlink(plot->temp);
  }
  return status;
}
