/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/mesh.h"

#include <math.h>

enum { MAX_CELLS = 1 << 15 }; /* along one axis: element and node numbers stay below 2^31 */

static pw_status count_cells(pw_real size, pw_real cell, const char *axis, pw_idx *out)
{
  pw_real count = round(size / cell);
  PW_REQUIRE(count >= 1.0 && fabs(size / cell - count) <= 1e-6, PW_ERR_SCENE,
             "grid: size along %s, %g m, is not a whole number of cells of %g m", axis, size, cell);
  PW_REQUIRE(count <= MAX_CELLS, PW_ERR_SCENE, "grid: %.0f cells along %s, at most %d are possible",
             count, axis, MAX_CELLS);
  *out = (pw_idx)count;
  return PW_OK;
}

pw_status pw_mesh_create(const pw_real *origin, const pw_real *size, pw_real cell, pw_mesh *out)
{
  PW_REQUIRE(cell > 0.0 && isfinite(cell), PW_ERR_SCENE, "grid: cell_m = %g is not a length", cell);
  pw_mesh m = {.origin = {origin[0], origin[1]}, .cell = cell};
  PW_TRY(count_cells(size[0], cell, "x", &m.cells[0]));
  PW_TRY(count_cells(size[1], cell, "y", &m.cells[1]));
  m.nodes[0] = m.cells[0] + 1;
  m.nodes[1] = m.cells[1] + 1;
  m.nelem = m.cells[0] * m.cells[1];
  m.nnode = m.nodes[0] * m.nodes[1];
  *out = m;
  return PW_OK;
}

pw_idx pw_mesh_locate(const pw_mesh *m, const pw_real *x)
{
  pw_idx k[2];
  for (int a = 0; a < 2; a++) {
    pw_real g = (x[a] - m->origin[a]) / m->cell;
    if (!(g >= 0.0 && g <= (pw_real)m->cells[a])) {
      return -1;
    }
    k[a] = (pw_idx)g < m->cells[a] ? (pw_idx)g : m->cells[a] - 1;
  }
  return k[1] * m->cells[0] + k[0];
}

void pw_mesh_shape(const pw_mesh *m, const pw_real *x, pw_idx *node, pw_real *weight)
{
  pw_idx k[2];
  pw_real a[2];
  for (int d = 0; d < 2; d++) {
    pw_real g = (x[d] - m->origin[d]) / m->cell;
    g = pw_min(g > 0.0 ? g : 0.0, (pw_real)m->cells[d]);
    k[d] = (pw_idx)g < m->cells[d] ? (pw_idx)g : m->cells[d] - 1;
    a[d] = g - (pw_real)k[d];
  }
  node[0] = k[1] * m->nodes[0] + k[0];
  node[1] = node[0] + 1;
  node[2] = node[0] + m->nodes[0];
  node[3] = node[2] + 1;
  weight[0] = (1.0 - a[0]) * (1.0 - a[1]);
  weight[1] = a[0] * (1.0 - a[1]);
  weight[2] = (1.0 - a[0]) * a[1];
  weight[3] = a[0] * a[1];
}
