/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

pw_status pw_path_join(const char *folder, const char *name, char *out)
{
  int length = snprintf(out, PW_PATH, "%s/%s", folder, name);
  PW_REQUIRE(length > 0 && length < PW_PATH, PW_ERR_FILE, "%s/%s: the path is too long", folder,
             name);
  return PW_OK;
}

static pw_status make_one_folder(const char *path)
{
  struct stat info;
  if (mkdir(path, 0777) == 0) {
    return PW_OK;
  }
  int reason = errno;
  if (reason == EEXIST && stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
    return PW_OK;
  }
  PW_REQUIRE(false, PW_ERR_FILE, "cannot make the folder %s: %s", path, strerror(reason));
}

pw_status pw_make_folder(const char *path)
{
  char part[PW_PATH];
  int length = snprintf(part, sizeof part, "%s", path);
  PW_REQUIRE(length > 0 && length < PW_PATH, PW_ERR_FILE, "%s: not a usable folder name", path);
  for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    *slash = '\0';
    PW_TRY(make_one_folder(part));
    *slash = '/';
  }
  return make_one_folder(part);
}

pw_status pw_atomic_temp(const char *path, char *temp)
{
  int length = snprintf(temp, PW_PATH, "%s.part", path);
  PW_REQUIRE(length > 0 && length < PW_PATH, PW_ERR_FILE, "%s: the path is too long", path);
  return PW_OK;
}

/* A rename is on the disk when its folder is. File systems that cannot synchronise a folder keep
 * the order of their own accord, so that a failure here is none of the file's. */
static void sync_folder(const char *path)
{
  char folder[PW_PATH];
  snprintf(folder, sizeof folder, "%s", path);
  char *slash = strrchr(folder, '/');
  if (slash == folder) {
    slash++;
  }
  if (slash) {
    *slash = '\0';
  }
  int fd = open(slash ? folder : ".", O_RDONLY | O_DIRECTORY);
  if (fd >= 0) {
    (void)fsync(fd);
    close(fd);
  }
}

pw_status pw_atomic_commit(const char *temp, const char *path)
{
  int fd = open(temp, O_RDONLY);
  bool good = fd >= 0 && fsync(fd) == 0;
  int reason = errno;
  if (fd >= 0) {
    close(fd);
  }
  if (good) {
    good = rename(temp, path) == 0;
    reason = errno;
  }
  if (!good) {
    unlink(temp);
  }
  PW_REQUIRE(good, PW_ERR_FILE, "cannot write %s: %s", path, strerror(reason));
  sync_folder(path);
  return PW_OK;
}

static int write_all(int fd, const char *bytes, size_t size)
{
  while (size > 0) {
    ssize_t done = write(fd, bytes, size < (1u << 30) ? size : (1u << 30));
    if (done < 0 && errno == EINTR) {
      continue;
    }
    if (done <= 0) {
      return done < 0 ? errno : EIO;
    }
    bytes += done;
    size -= (size_t)done;
  }
  return 0;
}

pw_status pw_atomic_write(const char *path, const void *bytes, size_t size)
{
  char temp[PW_PATH];
  PW_TRY(pw_atomic_temp(path, temp));
  int fd = open(temp, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  PW_REQUIRE(fd >= 0, PW_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
  int reason = write_all(fd, bytes, size);
  if (close(fd) != 0 && reason == 0) {
    reason = errno;
  }
  if (reason != 0) {
    unlink(temp);
  }
  PW_REQUIRE(reason == 0, PW_ERR_FILE, "cannot write %s: %s", path, strerror(reason));
  return pw_atomic_commit(temp, path);
}
