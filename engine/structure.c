/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/structure.h"

#include <stdio.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/structure_parts.h"

static bool is_rod(const pw_structure *s)
{
  return s->kind == PW_BODY_ROD;
}

/* Section at the top: what a pressure on the head acts on. */
static pw_real head_area(const pw_scene *scene, const pw_scene_body *b)
{
  const bool axi = scene->geometry == PW_AXI;
  const pw_real *x = b->x_m, r = b->radius_m;
  switch ((pw_shape)b->shape) {
  case PW_SHAPE_RECTANGLE:
    return axi ? 0.5 * (x[1] * x[1] - x[0] * x[0]) : x[1] - x[0];
  case PW_SHAPE_PILE:
    return axi ? 0.5 * r * r : 2.0 * r;
  case PW_SHAPE_DISC:
  case PW_SHAPE_RING:
    break;
  }
  return 0.0;
}

/* Places and velocities of the line's nodes; du is the displacement since the last call. */
static void place_line(pw_structure *s)
{
  for (pw_idx k = 0; k < s->line.n; k++) {
    pw_interface_node *node = &s->line.node[k];
    pw_real x[2], v[2];
    if (is_rod(s)) {
      pw_rod_place(s, k, x, v);
    } else {
      pw_rigid_place(s, k, x, v);
    }
    for (int a = 0; a < 2; a++) {
      node->du[a] = x[a] - node->x[a];
      node->x[a] = x[a];
      node->v[a] = v[a];
    }
  }
}

static pw_status create(const pw_scene *scene, int body, pw_real segment, pw_structure *s)
{
  const pw_scene_body *b = &scene->body[body];
  if (is_rod(s)) {
    PW_REQUIRE(b->shape == PW_SHAPE_PILE && b->rod_elements >= 1, PW_ERR_SCENE,
               "body %s: a rod is a pile of one element or more", b->name);
    PW_TRY(pw_rod_create(scene, body, &s->rod));
    segment = pw_min(segment, s->rod.length);
    s->centre0[0] = s->axi ? 0.0 : b->centre_m[0];
  } else {
    pw_rigid_create(scene, body, &s->rigid);
    PW_REQUIRE(s->rigid.mass > 0.0, PW_ERR_SCENE, "body %s: a mass of %g kg", b->name,
               s->rigid.mass);
    memcpy(s->centre0, s->rigid.x, sizeof s->centre0);
  }
  PW_TRY(pw_interface_from_body(scene, body, -1, segment, 0.0, &s->line));
  PW_TRY(pw_mem_alloc("structure surface", 2 * (pw_off)s->line.n, sizeof(pw_real), &s->line_x0));
  for (pw_idx k = 0; k < s->line.n; k++) {
    memcpy(s->line_x0 + 2 * k, s->line.node[k].x, sizeof s->line.node[k].x);
  }
  pw_real y[2];
  pw_shape_extent(scene, body, y);
  s->head_y = y[1];
  s->head_area = head_area(scene, b);
  return PW_OK;
}

pw_status pw_structure_create(const pw_scene *scene, int body, pw_real segment, pw_structure *out)
{
  pw_structure s = {.body = body, .kind = scene->body[body].kind, .axi = scene->geometry == PW_AXI};
  PW_REQUIRE(s.kind != PW_BODY_POINTS, PW_ERR_SCENE, "body %s is of points",
             scene->body[body].name);
  pw_status status = create(scene, body, segment, &s);
  if (status != PW_OK) {
    pw_structure_destroy(&s);
    return status;
  }
  *out = s;
  return PW_OK;
}

void pw_structure_destroy(pw_structure *s)
{
  pw_rod_destroy(&s->rod);
  pw_interface_destroy(&s->line);
  pw_mem_free(&s->line_x0);
}

void pw_structure_clear(pw_structure *s)
{
  if (is_rod(s)) {
    memset(s->rod.force, 0, (size_t)s->rod.n * sizeof(pw_real));
    memset(s->rod.load, 0, (size_t)s->rod.n * sizeof(pw_real));
    return;
  }
  pw_rigid *r = &s->rigid;
  for (int a = 0; a < 3; a++) {
    r->force[a] = r->moment[a] = 0.0;
  }
  r->load[0] = r->load[1] = r->load_moment = 0.0;
}

void pw_structure_add_force(pw_structure *s, pw_idx segment, pw_real xi, const pw_real *f)
{
  pw_idx next = pw_interface_next(&s->line, segment);
  const pw_real *a = s->line.node[segment].x, *b = s->line.node[next].x;
  if (is_rod(s)) { /* the line moves with its nodes: so do the forces */
    pw_rod_add(&s->rod, s->line_x0[2 * segment + 1], (1.0 - xi) * f[1]);
    pw_rod_add(&s->rod, s->line_x0[2 * next + 1], xi * f[1]);
    return;
  }
  pw_real x[2] = {(1.0 - xi) * a[0] + xi * b[0], (1.0 - xi) * a[1] + xi * b[1]};
  pw_rigid_add(s, x, f, false);
}

void pw_structure_add_head_force(pw_structure *s, pw_real f)
{
  if (is_rod(s)) {
    s->rod.force[s->rod.n - 1] += f;
    s->rod.load[s->rod.n - 1] += f;
    return;
  }
  const pw_real *q = s->rigid.rotation, arm = s->head_y - s->centre0[1];
  pw_real x[2] = {s->rigid.x[0] + 2.0 * (q[1] * q[2] - q[0] * q[3]) * arm,
                  s->rigid.x[1] + (1.0 - 2.0 * (q[1] * q[1] + q[3] * q[3])) * arm};
  pw_rigid_add(s, x, (pw_real[]){0.0, f}, true);
}

void pw_structure_add_weight(pw_structure *s, const pw_real *a)
{
  if (is_rod(s)) {
    pw_rod_add_weight(&s->rod, a[1]);
    return;
  }
  pw_rigid *r = &s->rigid;
  pw_rigid_add(s, r->x, (pw_real[]){r->mass * a[0], r->mass * a[1]}, true);
}

void pw_structure_set_velocity(pw_structure *s, const pw_real *v)
{
  for (int a = 0; a < 2; a++) {
    s->rigid.v[a] = v[a];
  }
  s->rigid.spin[2] = 0.0;
  for (pw_idx k = 0; k < s->rod.n; k++) {
    s->rod.v[k] = v[1];
  }
  pw_interface_set_velocity(&s->line, v);
}

void pw_structure_kick(pw_structure *s, pw_real dt, const pw_real *given)
{
  if (is_rod(s)) {
    pw_rod_kick(s, dt, given);
  } else {
    pw_rigid_kick(s, dt, given);
  }
}

void pw_structure_drift(pw_structure *s, pw_real dt)
{
  if (is_rod(s)) {
    pw_rod_drift(s, dt);
  } else {
    pw_rigid_drift(s, dt);
  }
  place_line(s);
}

pw_real pw_structure_kinetic(const pw_structure *s)
{
  if (is_rod(s)) {
    return pw_rod_kinetic(&s->rod);
  }
  const pw_rigid *r = &s->rigid;
  return 0.5 * r->mass * (r->v[0] * r->v[0] + r->v[1] * r->v[1]) +
         0.5 * r->inertia[2] * r->spin[2] * r->spin[2];
}

pw_real pw_structure_strain(const pw_structure *s)
{
  return is_rod(s) ? pw_rod_strain(&s->rod) : 0.0;
}

void pw_structure_centre(const pw_structure *s, pw_real *com)
{
  const pw_rigid *r = &s->rigid;
  const pw_rod *rod = &s->rod;
  if (!is_rod(s)) {
    memcpy(com, (pw_real[]){r->x[0], r->x[1], r->v[0], r->v[1], r->spin[2], r->mass},
           6 * sizeof *com);
    return;
  }
  pw_real m = 0.0, y = 0.0, v = 0.0;
  for (pw_idx k = 0; k < rod->n; k++) {
    m += rod->mass[k];
    y += rod->mass[k] * (rod->y0 + (pw_real)k * rod->length + rod->u[k]);
    v += rod->mass[k] * rod->v[k];
  }
  memcpy(com, (pw_real[]){s->centre0[0], y / m, 0.0, v / m, 0.0, m}, 6 * sizeof *com);
}

pw_real pw_structure_tip(const pw_structure *s)
{
  pw_real y = PW_HUGE;
  for (pw_idx k = 0; k < s->line.n; k++) {
    y = pw_min(y, s->line.node[k].x[1]);
  }
  return y;
}

int pw_structure_outline(const pw_structure *s, pw_real *xy, int max)
{
  const pw_interface *line = &s->line;
  int n = line->n + (line->closed ? 1 : 0);
  if (n > max) {
    return -1;
  }
  for (int k = 0; k < n; k++) {
    memcpy(xy + 2 * k, line->node[k % line->n].x, 2 * sizeof *xy);
  }
  return n;
}

pw_status pw_structure_archive(pw_structure *s, pw_archive *ar)
{
  char name[PW_NAME], path[2 * PW_NAME];
  snprintf(name, sizeof name, "structure_%d", s->body);
  if (is_rod(s)) {
    PW_TRY(pw_rod_archive(&s->rod, name, ar));
  } else {
    PW_TRY(pw_rigid_archive(&s->rigid, name, ar));
  }
  pw_real last[4] = {s->work, s->given_work, s->reaction[0], s->reaction[1]};
  snprintf(path, sizeof path, "%s/last", name);
  PW_TRY(ar->real(ar, path, last, 4));
  s->work = last[0];
  s->given_work = last[1];
  memcpy(s->reaction, last + 2, sizeof s->reaction);
  snprintf(path, sizeof path, "%s/surface", name);
  return pw_interface_archive(&s->line, path, ar);
}
