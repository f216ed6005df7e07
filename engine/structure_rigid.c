/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigid body. Its rotation is a quaternion, turned by the exact rotation of a step's spin. */
#include "engine/structure_parts.h"

#include <math.h>
#include <stdio.h>

void pw_rigid_create(const pw_scene *scene, int body, pw_rigid *out)
{
  const pw_scene_body *b = &scene->body[body];
  const bool axi = scene->geometry == PW_AXI;
  pw_real y[2], middle = pw_shape_extent(scene, body, y);
  const pw_slice m = pw_shape_slice(scene, body, y[0], y[1]);
  pw_real density = pw_scene_density(scene, body), centre = m.y / m.vol;
  if (b->mass_kg > 0.0) {
    density = b->mass_kg / (m.vol * (axi ? 6.283185307179586 : 1.0));
  }
  pw_real upright = density * pw_max(0.0, m.yy - centre * m.y), wide = density * m.wide2;
  *out = (pw_rigid){.mass = density * m.vol,
                    .inertia = {upright, wide, upright + wide},
                    .x = {middle, centre, 0.0},
                    .v = {b->velocity_m_s[0], b->velocity_m_s[1], 0.0},
                    .rotation = {1.0, 0.0, 0.0, 0.0}};
  if (axi) { /* x^2 + z^2 = r^2 is shared by both directions across the axis */
    out->inertia[0] = out->inertia[2] = upright + 0.5 * wide;
  }
}

void pw_rigid_add(pw_structure *s, const pw_real *x, const pw_real *f, bool load)
{
  pw_rigid *r = &s->rigid;
  pw_real fx = s->axi ? 0.0 : f[0]; /* around the axis radial forces balance */
  pw_real moment = s->axi ? 0.0 : (x[0] - r->x[0]) * f[1] - (x[1] - r->x[1]) * fx;
  r->force[0] += fx;
  r->force[1] += f[1];
  r->moment[2] += moment;
  if (load) {
    r->load[0] += fx;
    r->load[1] += f[1];
    r->load_moment += moment;
  }
}

static void kick_given(pw_structure *s, pw_real dt, const pw_real *given)
{
  pw_rigid *r = &s->rigid;
  for (int a = 0; a < 2; a++) {
    s->reaction[a] = r->mass * (given[a] - r->v[a]) / dt - r->force[a];
    s->given_work += dt * s->reaction[a] * 0.5 * (r->v[a] + given[a]);
    s->work += dt * r->load[a] * 0.5 * (r->v[a] + given[a]);
    r->v[a] = given[a];
  }
  r->spin[2] = 0.0;
}

void pw_rigid_kick(pw_structure *s, pw_real dt, const pw_real *given)
{
  pw_rigid *r = &s->rigid;
  s->work = s->given_work = s->reaction[0] = s->reaction[1] = 0.0;
  if (given) {
    kick_given(s, dt, given);
    return;
  }
  for (int a = 0; a < 2; a++) {
    pw_real dv = dt * r->force[a] / r->mass;
    s->work += dt * r->load[a] * (r->v[a] + 0.5 * dv);
    r->v[a] += dv;
  }
  if (!s->axi) {
    pw_real dspin = dt * r->moment[2] / r->inertia[2];
    s->work += dt * r->load_moment * (r->spin[2] + 0.5 * dspin);
    r->spin[2] += dspin;
  }
}

/* Turn by the angle |spin| dt about the spin: rotation = turn * rotation. */
static void turn(pw_rigid *r, pw_real dt)
{
  const pw_real *w = r->spin;
  pw_real speed = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (!(speed > 0.0)) {
    return;
  }
  pw_real c = cos(0.5 * dt * speed), f = sin(0.5 * dt * speed) / speed;
  pw_real x = f * w[0], y = f * w[1], z = f * w[2];
  pw_real *q = r->rotation, q0 = q[0], q1 = q[1], q2 = q[2], q3 = q[3];
  q[0] = c * q0 - x * q1 - y * q2 - z * q3;
  q[1] = c * q1 + x * q0 + y * q3 - z * q2;
  q[2] = c * q2 + y * q0 + z * q1 - x * q3;
  q[3] = c * q3 + z * q0 + x * q2 - y * q1;
  pw_real inv = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; k++) {
    q[k] *= inv;
  }
}

void pw_rigid_drift(pw_structure *s, pw_real dt)
{
  pw_rigid *r = &s->rigid;
  for (int a = 0; a < 2; a++) {
    r->x[a] += dt * r->v[a];
  }
  turn(r, dt);
}

void pw_rigid_place(const pw_structure *s, pw_idx node, pw_real *x, pw_real *v)
{
  const pw_rigid *r = &s->rigid;
  const pw_real *x0 = s->line_x0 + 2 * node, *q = r->rotation;
  if (s->axi) {
    x[0] = x0[0];
    x[1] = r->x[1] + (x0[1] - s->centre0[1]);
    v[0] = 0.0;
    v[1] = r->v[1];
    return;
  }
  pw_real a = x0[0] - s->centre0[0], b = x0[1] - s->centre0[1];
  pw_real dx =
      (1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3])) * a + 2.0 * (q[1] * q[2] - q[0] * q[3]) * b;
  pw_real dy =
      2.0 * (q[1] * q[2] + q[0] * q[3]) * a + (1.0 - 2.0 * (q[1] * q[1] + q[3] * q[3])) * b;
  x[0] = r->x[0] + dx;
  x[1] = r->x[1] + dy;
  v[0] = r->v[0] - r->spin[2] * dy;
  v[1] = r->v[1] + r->spin[2] * dx;
}

pw_status pw_rigid_archive(pw_rigid *r, const char *name, pw_archive *ar)
{
  char path[2 * PW_NAME];
  struct {
    const char *name;
    pw_real *value;
    pw_off count;
  } part[] = {{"x", r->x, 3}, {"v", r->v, 3}, {"rotation", r->rotation, 4}, {"spin", r->spin, 3}};
  for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
    snprintf(path, sizeof path, "%s/%s", name, part[k].name);
    PW_TRY(ar->real(ar, path, part[k].value, part[k].count));
  }
  return PW_OK;
}
