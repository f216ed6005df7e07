/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/vtk_files.h"

#ifndef PW_HAVE_VTK

#define REFUSE(path)                                                                               \
  PW_REQUIRE(false, PW_ERR_UNSUPPORTED,                                                            \
             "%s: built without VTK, no ParaView files (Debian package: libvtk9-dev)", path)

bool pw_vtk_available(void)
{
  return false;
}

pw_status pw_vtk_write_cells(const char *path, const pw_vtk_cells *cells)
{
  (void)cells;
  REFUSE(path);
}

pw_status pw_vtk_write_tets(const char *path, const pw_vtk_tets *tets)
{
  (void)tets;
  REFUSE(path);
}

pw_status pw_vtk_write_grid(const char *path, const pw_vtk_grid *grid)
{
  (void)grid;
  REFUSE(path);
}

pw_status pw_vtk_read_array(const char *path, const char *name, float *value, pw_off max,
                            pw_vtk_shape *shape)
{
  (void)name, (void)value, (void)max, (void)shape;
  REFUSE(path);
}

#endif
