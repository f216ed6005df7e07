/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/run_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* "cases/bar_wave/scene.yaml" -> "bar_wave", "soil.yaml" -> "soil": [first, first + length). */
static const char *scene_name(const char *file, int *length)
{
  const char *slash = strrchr(file, '/');
  const char *first = slash ? slash + 1 : file;
  const char *dot = strrchr(first, '.');
  *length = (int)(dot && dot > first ? dot - first : (long)strlen(first));
  if (slash && *length == 5 && strncmp(first, "scene", 5) == 0) {
    const char *end = slash;
    first = end;
    while (first > file && first[-1] != '/') {
      first--;
    }
    if (end > first && *first != '.') {
      *length = (int)(end - first);
    } else {
      first = slash + 1;
    }
  }
  return first;
}

pw_status pw_run_folder_name(const char *path, const char *scene_file, pw_run_folder *out)
{
  int length = 0;
  const char *name = scene_name(scene_file, &length);
  int n = path ? snprintf(out->path, PW_PATH, "%s", path)
               : snprintf(out->path, PW_PATH, "out/%.*s", length, name);

  PW_REQUIRE(n > 0 && n<PW_PATH, PW_ERR_FILE, "the name of the output folder is %s", n> 0
                 ? "too long"
                 : "empty");
  PW_TRY(pw_path_join(out->path, "summary.json", out->summary));
  PW_TRY(pw_path_join(out->path, "history.csv", out->history));
  PW_TRY(pw_path_join(out->path, "checkpoint.h5", out->checkpoint));
  PW_TRY(pw_path_join(out->path, "pictures", out->pictures));
  return pw_path_join(out->path, "paraview", out->paraview);
}

bool pw_run_folder_holds_checkpoint(const pw_run_folder *f)
{
  return access(f->checkpoint, F_OK) == 0;
}

bool pw_run_folder_holds_run(const pw_run_folder *f)
{
  return pw_run_folder_holds_checkpoint(f) || access(f->summary, F_OK) == 0;
}

bool pw_run_folder_finished(const pw_run_folder *f)
{
  char head[2048]; /* the status stands in the first lines */
  FILE *file = fopen(f->summary, "rb");
  if (!file) {
    return false;
  }
  head[fread(head, 1, sizeof head - 1, file)] = '\0';
  fclose(file);
  return strstr(head, "\"status\": \"finished\"") != NULL;
}

pw_status pw_run_folder_lock(const pw_run_folder *f, int *lock)
{
  *lock = -1;
  PW_TRY(pw_make_folder(f->path));
  int fd = open(f->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0) {
    bool busy = errno == EWOULDBLOCK;
    close(fd);
    fd = -1;
    PW_REQUIRE(!busy, PW_ERR_INTERRUPTED, "another run is at work in %s", f->path);
  }
  *lock = fd;
  return PW_OK;
}

static pw_status remove_file(const char *path)
{
  PW_REQUIRE(unlink(path) == 0 || errno == ENOENT, PW_ERR_FILE, "cannot remove %s: %s", path,
             strerror(errno));
  return PW_OK;
}

/* Remove the files of `folder` with one of the endings; a missing folder is fine. */
static pw_status remove_files(const char *folder, const char *const *endings)
{
  DIR *dir = opendir(folder);
  pw_status status = PW_OK;
  char path[PW_PATH];

  if (!dir) {
    return PW_OK;
  }
  for (struct dirent *entry = readdir(dir); entry && status == PW_OK; entry = readdir(dir)) {
    const char *dot = strrchr(entry->d_name, '.');
    for (int i = 0; dot && endings[i] && status == PW_OK; i++) {
      if (strcmp(dot, endings[i]) == 0) {
        status = pw_path_join(folder, entry->d_name, path);
        status = status == PW_OK ? remove_file(path) : status;
      }
    }
  }
  closedir(dir);
  return status;
}

pw_status pw_run_folder_clear(const pw_run_folder *f)
{
  static const char *const picture[] = {".png", ".field", NULL};
  static const char *const paraview[] = {".vtp", ".vtu", ".vti", ".vtr", ".pvd", NULL};

  PW_TRY(remove_file(f->checkpoint));
  PW_TRY(remove_file(f->summary));
  PW_TRY(remove_file(f->history));
  PW_TRY(remove_files(f->pictures, picture));
  return remove_files(f->paraview, paraview);
}
