/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/restart.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "io/atomic_file.h"

enum {
  FORMAT_VERSION = 1,
  VERSION_BYTES = 16,
  IMAGE_GROWTH = 4 << 20 /* bytes the file's image in memory grows by */
};

/* The visitor on HDF5. HDF5's handles are closed in the reverse order of their making; a negative
 * handle is accepted by close_* and ignored. */
typedef struct h5_archive {
  pw_archive base;
  const char *path;
  hid_t file;
  hid_t object_list; /* creation properties: no times in the file */
  int64_t datasets;  /* arrays written or read so far */
} h5_archive;

static herr_t keep_first_cause(unsigned n, const H5E_error2_t *error, void *text)
{
  if (n == 0 && error->desc) {
    snprintf(text, 256, "%s", error->desc);
  }
  return 0;
}

/* The innermost entry of HDF5's error stack says what went wrong; the others say on whose behalf. */
static pw_status fail(const char *path, const char *what, const char *name)
{
  char cause[256] = "";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first_cause, cause);
  PW_REQUIRE(false, PW_ERR_FILE, "%s: %s%s%s%s%s", path, what, *name ? " " : "", name,
             *cause ? ": HDF5: " : "", cause);
}

static void silence(void)
{
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5Eclear2(H5E_DEFAULT);
}

/* ---- attributes of the root group ---- */

static hid_t text_type(size_t bytes)
{
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

static bool put_attribute(hid_t file, const char *name, hid_t type, hid_t memory, const void *value)
{
  hid_t space = H5Screate(H5S_SCALAR);
  hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  bool good = attribute >= 0 && H5Awrite(attribute, memory, value) >= 0;
  if (attribute >= 0) {
    good = H5Aclose(attribute) >= 0 && good;
  }
  H5Sclose(space);
  return good;
}

static bool put_text(hid_t file, const char *name, size_t bytes, const char *value)
{
  char padded[PW_NAME] = "";
  snprintf(padded, bytes < sizeof padded ? bytes : sizeof padded, "%s", value);
  hid_t type = text_type(bytes);
  bool good = put_attribute(file, name, type, type, padded);
  H5Tclose(type);
  return good;
}

static bool put_stamp(const h5_archive *ar, const pw_restart_stamp *stamp)
{
  const int64_t format = FORMAT_VERSION;
  hid_t file = ar->file;
  return put_attribute(file, "format_version", H5T_STD_I64LE, H5T_NATIVE_INT64, &format) &&
         put_text(file, "program_version", VERSION_BYTES, PW_VERSION) &&
         put_text(file, "title", PW_NAME, stamp->title) &&
         put_attribute(file, "time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &stamp->time_s) &&
         put_attribute(file, "step", H5T_STD_I64LE, H5T_NATIVE_INT64, &stamp->step) &&
         put_attribute(file, "datasets", H5T_STD_I64LE, H5T_NATIVE_INT64, &ar->datasets);
}

static pw_status get_attribute(const h5_archive *ar, const char *name, hid_t stored, hid_t memory,
                               void *value)
{
  hid_t attribute = H5Aopen(ar->file, name, H5P_DEFAULT);
  if (attribute < 0) {
    return fail(ar->path, "not a checkpoint of this program, no attribute", name);
  }
  hid_t type = H5Aget_type(attribute);
  hid_t space = H5Aget_space(attribute);
  bool good = H5Tequal(type, stored) > 0 && H5Sget_simple_extent_type(space) == H5S_SCALAR &&
              H5Aread(attribute, memory, value) >= 0;
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return good ? PW_OK : fail(ar->path, "cannot read attribute", name);
}

static pw_status get_stamp(const h5_archive *ar, pw_restart_stamp *stamp, int64_t *datasets)
{
  int64_t format = 0;
  PW_TRY(get_attribute(ar, "format_version", H5T_STD_I64LE, H5T_NATIVE_INT64, &format));
  PW_REQUIRE(format == FORMAT_VERSION, PW_ERR_FILE,
             "%s: the checkpoint has format version %lld, this program reads version %d", ar->path,
             (long long)format, FORMAT_VERSION);
  hid_t type = text_type(PW_NAME);
  pw_status status = get_attribute(ar, "title", type, type, stamp->title);
  H5Tclose(type);
  PW_TRY(status);
  stamp->title[PW_NAME - 1] = '\0';
  PW_TRY(get_attribute(ar, "time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &stamp->time_s));
  PW_TRY(get_attribute(ar, "step", H5T_STD_I64LE, H5T_NATIVE_INT64, &stamp->step));
  return get_attribute(ar, "datasets", H5T_STD_I64LE, H5T_NATIVE_INT64, datasets);
}

/* ---- arrays ---- */

/* Make the groups that lead to "points/stress". */
static bool make_groups(const h5_archive *ar, const char *name)
{
  char group[PW_PATH];
  for (const char *slash = strchr(name, '/'); slash; slash = strchr(slash + 1, '/')) {
    size_t length = (size_t)(slash - name);
    if (length == 0 || length >= sizeof group) {
      return false;
    }
    memcpy(group, name, length);
    group[length] = '\0';
    if (H5Lexists(ar->file, group, H5P_DEFAULT) > 0) {
      continue;
    }
    hid_t list = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(list, false);
    hid_t made = H5Gcreate2(ar->file, group, H5P_DEFAULT, list, H5P_DEFAULT);
    H5Pclose(list);
    if (made < 0 || H5Gclose(made) < 0) {
      return false;
    }
  }
  return true;
}

static pw_status save_array(h5_archive *ar, const char *name, hid_t stored, hid_t memory,
                            const void *value, pw_off count)
{
  hsize_t size = (hsize_t)count;
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t set = -1;
  if (space >= 0 && make_groups(ar, name)) {
    set = H5Dcreate2(ar->file, name, stored, space, H5P_DEFAULT, ar->object_list, H5P_DEFAULT);
  }
  bool good = set >= 0;
  if (good && count > 0) {
    good = H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0;
  }
  if (set >= 0) {
    good = H5Dclose(set) >= 0 && good;
  }
  if (space >= 0) {
    H5Sclose(space);
  }
  return good ? PW_OK : fail(ar->path, "cannot store", name);
}

static pw_status read_opened(const h5_archive *ar, const char *name, hid_t set, hid_t stored,
                             hid_t memory, void *value, pw_off count)
{
  hid_t type = H5Dget_type(set);
  hid_t space = H5Dget_space(set);
  bool same_type = type >= 0 && H5Tequal(type, stored) > 0;
  hssize_t found = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  H5Tclose(type);
  H5Sclose(space);
  PW_REQUIRE(same_type, PW_ERR_FILE, "%s: %s holds another type of number", ar->path, name);
  PW_REQUIRE(found == count, PW_ERR_FILE, "%s: %s holds %lld values, this scene needs %lld",
             ar->path, name, (long long)found, (long long)count);
  if (count > 0 && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) {
    return fail(ar->path, "cannot read", name);
  }
  return PW_OK;
}

static pw_status load_array(h5_archive *ar, const char *name, hid_t stored, hid_t memory,
                            void *value, pw_off count)
{
  hid_t set = H5Dopen2(ar->file, name, H5P_DEFAULT);
  PW_REQUIRE(set >= 0, PW_ERR_FILE, "%s: the checkpoint has no %s, which this scene needs",
             ar->path, name);
  pw_status status = read_opened(ar, name, set, stored, memory, value, count);
  H5Dclose(set);
  return status;
}

static pw_status visit(pw_archive *base, const char *name, hid_t stored, hid_t memory, void *value,
                       pw_off count)
{
  h5_archive *ar = (h5_archive *)base; /* base is the first member */
  PW_REQUIRE(count >= 0, PW_ERR_ARGUMENT, "%s: %lld values is not a size", name, (long long)count);
  ar->datasets++;
  return base->loading ? load_array(ar, name, stored, memory, value, count)
                       : save_array(ar, name, stored, memory, value, count);
}

static pw_status visit_real(pw_archive *ar, const char *name, pw_real *value, pw_off count)
{
  return visit(ar, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, value, count);
}

static pw_status visit_index(pw_archive *ar, const char *name, pw_idx *value, pw_off count)
{
  return visit(ar, name, H5T_STD_I32LE, H5T_NATIVE_INT32, value, count);
}

static pw_status visit_offset(pw_archive *ar, const char *name, pw_off *value, pw_off count)
{
  return visit(ar, name, H5T_STD_I64LE, H5T_NATIVE_INT64, value, count);
}

static h5_archive archive_on(const char *path, bool loading)
{
  silence();
  return (h5_archive){
      .base = {loading, visit_real, visit_index, visit_offset},
      .path = path,
      .file = -1,
      .object_list = -1,
  };
}

/* ---- writing: the file is an image in memory until it is complete ---- */

static hid_t create_image(const char *path)
{
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  hid_t create = H5Pcreate(H5P_FILE_CREATE);
  hid_t file = -1;
  if (H5Pset_fapl_core(access, IMAGE_GROWTH, false) >= 0 &&
      H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) >= 0 &&
      H5Pset_obj_track_times(create, false) >= 0) {
    file = H5Fcreate(path, H5F_ACC_TRUNC, create, access);
  }
  H5Pclose(create);
  H5Pclose(access);
  return file;
}

static pw_status save_image(const h5_archive *ar)
{
  void *handle = NULL;
  ssize_t size = -1;
  if (H5Fflush(ar->file, H5F_SCOPE_GLOBAL) >= 0) {
    size = H5Fget_file_image(ar->file, NULL, 0);
  }
  if (size <= 0 || H5Fget_vfd_handle(ar->file, H5P_DEFAULT, &handle) < 0) {
    return fail(ar->path, "cannot complete the checkpoint", "");
  }
  /* The handle of a file in memory is the address of the pointer to its bytes. */
  const void *bytes = *(void **)handle;
  return pw_atomic_write(ar->path, bytes, (size_t)size);
}

static pw_status fill_and_save(h5_archive *ar, const pw_restart_stamp *stamp, pw_archive_walk walk,
                               void *ctx)
{
  PW_TRY(walk(&ar->base, ctx));
  if (!put_stamp(ar, stamp)) {
    return fail(ar->path, "cannot store the attributes", "");
  }
  return save_image(ar);
}

pw_status pw_archive_write(const char *path, const pw_restart_stamp *stamp, pw_archive_walk walk,
                           void *ctx)
{
  h5_archive ar = archive_on(path, false);
  ar.file = create_image(path);
  if (ar.file < 0) {
    return fail(path, "cannot start the checkpoint", "");
  }
  ar.object_list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(ar.object_list, false);
  H5Pset_layout(ar.object_list, H5D_CONTIGUOUS);
  H5Pset_fill_time(ar.object_list, H5D_FILL_TIME_NEVER);
  pw_status status = fill_and_save(&ar, stamp, walk, ctx);
  H5Pclose(ar.object_list);
  H5Fclose(ar.file);
  return status;
}

/* ---- reading ---- */

static pw_status open_for_reading(h5_archive *ar)
{
  int fd = open(ar->path, O_RDONLY);
  PW_REQUIRE(fd >= 0, PW_ERR_FILE, "cannot read %s: %s", ar->path, strerror(errno));
  close(fd);
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_file_locking(access, false, true);
  ar->file = H5Fopen(ar->path, H5F_ACC_RDONLY, access);
  H5Pclose(access);
  return ar->file >= 0 ? PW_OK : fail(ar->path, "not a whole checkpoint", "");
}

static pw_status load_all(h5_archive *ar, pw_archive_walk walk, void *ctx)
{
  pw_restart_stamp stamp;
  int64_t stored = 0;
  PW_TRY(get_stamp(ar, &stamp, &stored));
  PW_TRY(walk(&ar->base, ctx));
  PW_REQUIRE(ar->datasets == stored, PW_ERR_FILE,
             "%s: the checkpoint holds %lld arrays, this scene has %lld: it is of another scene",
             ar->path, (long long)stored, (long long)ar->datasets);
  return PW_OK;
}

pw_status pw_archive_read(const char *path, pw_archive_walk walk, void *ctx)
{
  h5_archive ar = archive_on(path, true);
  PW_TRY(open_for_reading(&ar));
  pw_status status = load_all(&ar, walk, ctx);
  H5Fclose(ar.file);
  return status;
}

pw_status pw_restart_peek(const char *path, pw_restart_stamp *out)
{
  h5_archive ar = archive_on(path, true);
  int64_t stored = 0;
  PW_TRY(open_for_reading(&ar));
  pw_status status = get_stamp(&ar, out, &stored);
  H5Fclose(ar.file);
  return status;
}

static pw_status walk_sim(pw_archive *ar, void *sim)
{
  return pw_sim_archive(sim, ar);
}

pw_status pw_restart_write(const char *path, pw_sim *sim)
{
  pw_restart_stamp stamp = {.time_s = pw_sim_time(sim), .step = pw_sim_steps(sim)};
  snprintf(stamp.title, sizeof stamp.title, "%s", pw_sim_scene(sim)->title);
  return pw_archive_write(path, &stamp, walk_sim, sim);
}

pw_status pw_restart_read(const char *path, pw_sim *sim)
{
  return pw_archive_read(path, walk_sim, sim);
}
