/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/point_values.h"

#include <math.h>
#include <string.h>

static const pw_scene_material *material_of(const pw_scene *scene, int b)
{
  return &scene->material[scene->body[b].material];
}

static int find_or_add(pw_state_column *column, int *n, const char *name)
{
  for (int k = 0; k < *n; k++) {
    if (strcmp(column[k].name, name) == 0) {
      return k;
    }
  }
  if (*n == PW_MAX_STATE_COLUMNS) {
    return -1;
  }
  column[*n].name = name;
  for (int b = 0; b < PW_MAX_BODIES; b++) {
    column[*n].component[b] = -1;
  }
  return (*n)++;
}

int pw_state_columns(const pw_scene *scene, pw_state_column *column)
{
  int n = 0;
  for (int b = 0; b < scene->nbody; b++) {
    const pw_scene_material *m = material_of(scene, b);
    int carried = m->model->nstate ? m->model->nstate(m->param) : 0;
    for (int c = 0; c < carried; c++) {
      const pw_state_def *state = &m->model->states[c];
      int k = state->output ? find_or_add(column, &n, state->name) : -1;
      if (k >= 0) {
        column[k].component[b] = c;
      }
    }
  }
  return n;
}

pw_real pw_point_state(const pw_points *p, const pw_state_column *column, pw_idx i)
{
  int c = column->component[p->body[i]];
  return c >= 0 && p->state ? p->state[(pw_off)c * p->ld + i] : (pw_real)NAN;
}

bool pw_body_has_angle(const pw_scene *scene, int b)
{
  return material_of(scene, b)->model->mobilised_angle != NULL;
}

pw_real pw_point_angle_deg(const pw_scene *scene, const pw_points *p, pw_idx i)
{
  const pw_scene_material *m = material_of(scene, p->body[i]);
  if (!m->model->mobilised_angle) {
    return (pw_real)NAN;
  }
  pw_real stress[6];
  for (int c = 0; c < 6; c++) {
    stress[c] = p->stress[(pw_off)c * p->ld + i];
  }
  return m->model->mobilised_angle(m->param, stress) * (180.0 / acos(-1.0));
}

bool pw_points_have_domains(const pw_points *p)
{
  return p->half || p->half0;
}

void pw_point_corners(const pw_points *p, pw_idx i, pw_real *xy)
{
  static const pw_real s[4] = {-1.0, 1.0, 1.0, -1.0}, t[4] = {-1.0, -1.0, 1.0, 1.0};
  const pw_real *half = p->half ? p->half : p->half0;
  for (int k = 0; k < 4; k++) {
    for (int d = 0; d < 2; d++) {
      xy[2 * k + d] = p->x[(pw_off)d * p->ld + i] + s[k] * half[(pw_off)d * p->ld + i] +
                      t[k] * half[(pw_off)(2 + d) * p->ld + i];
    }
  }
}
