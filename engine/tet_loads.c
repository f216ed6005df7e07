/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_loads.h"

#include <math.h>
#include <string.h>

void pw_tet_model_shape(const pw_tet_model *m, pw_idx point, pw_real *shape)
{
  const size_t l = (size_t)m->points.ld, i = (size_t)point;
  const pw_real *x = m->points.x, now[3] = {x[i], x[l + i], x[2 * l + i]};
  pw_real back[3];
  pw_motion_back(&m->mesh->motion, now, back);
  pw_tets_shape(&m->mesh->tets, m->points.elem[point], back, shape);
}

void pw_tet_model_masses(pw_tet_model *m)
{
  const pw_tets *t = &m->mesh->tets;
  if (m->has_mass) {
    return;
  }
  memset(m->mass, 0, (size_t)t->nnode * sizeof *m->mass);
  for (pw_idx i = 0; i < m->points.n; i++) {
    const pw_idx *node = t->node + 4 * (size_t)m->points.elem[i];
    pw_real shape[4];
    pw_tet_model_shape(m, i, shape);
    for (int a = 0; a < 4; a++) {
      m->mass[node[a]] += m->points.mass[i] * shape[a];
    }
  }
  m->has_mass = true;
}

void pw_tet_model_gravity(pw_tet_model *m, const pw_real *g)
{
  const size_t n = (size_t)m->mesh->tets.nnode;
  pw_tet_model_masses(m);
  for (size_t c = 0; c < 3; c++) {
    for (size_t a = 0; a < n && g[c] != 0.0; a++) {
      m->external[c * n + a] += m->mass[a] * g[c];
    }
  }
}

pw_status pw_tet_model_prestress(pw_tet_model *m, pw_tet_stress_fn fn, void *ctx)
{
  pw_tet_points *q = &m->points;
  const size_t l = (size_t)q->ld;
  for (pw_idx i = 0; i < q->n; i++) {
    const size_t p = (size_t)i;
    const pw_tet_material *material = &m->material[q->body[i]];
    const pw_real x[3] = {q->x[p], q->x[l + p], q->x[2 * l + p]};
    pw_real stress[6];
    fn(ctx, x, q->body[i], stress);
    if (!material->model->takes_initial_stress) {
      pw_real sum = 0.0;
      for (int c = 0; c < 6; c++) {
        sum += fabs(stress[c]);
      }
      PW_REQUIRE(sum == 0.0, PW_ERR_UNSUPPORTED, "material %s cannot start under stress",
                 material->model->name);
      continue;
    }
    for (size_t c = 0; c < 6; c++) {
      q->stress[c * l + p] = stress[c];
    }
    material->model->init(material->param, 1, q->ld, q->stress + p, q->state + p);
  }
  return PW_OK;
}
