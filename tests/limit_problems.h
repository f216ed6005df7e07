/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/limit_problems.h
 * @brief Plastic limit loads in plane strain: Prandtl's footing and the double-notched specimen, each
 *        a slab one brick thick between rollers.
 *
 * The figure of a problem is the load over its exact limit. Prescribed displacements move in
 * proportion to `push`, so that the load is the work of all forces on it.
 */
#ifndef PW_TESTS_LIMIT_PROBLEMS_H
#define PW_TESTS_LIMIT_PROBLEMS_H

#include "tests/solid_helpers.h"

typedef struct limit_case {
  pw_idx bricks[2]; /* along the axes of the unit square that is mapped */
  int per_brick;
  pw_fbar fbar;
  double thick;                 /* of the slab; m */
  double young, poisson, yield; /* Pa, -, Pa: the yield of a uniaxial test */
  pw_idx under;                 /* bricks along x under the strip, or in the ligament */
  double growth[3]; /* log of last over first brick: under the strip, beside it, with depth */
  double wide, deep;
  bool rough;
} limit_case;

/** Distance that grows from 0 to @p length as @p part goes from 0 to 1, bricks by exp(@p growth). */
static inline double limit_graded(double part, double length, double growth)
{
  return growth > 0.0 ? length * expm1(growth * part) / expm1(growth) : length * part;
}

/** The half x >= 0 of a strip of width 1 at y = 0 above soil; its edge is at x = 0.5. */
static inline void limit_strip_map(const void *ctx, pw_real *x)
{
  const limit_case *c = ctx;
  const double edge = (double)c->under / (double)c->bricks[0];
  const double in = x[0] / edge, out = (x[0] - edge) / (1.0 - edge);
  x[0] = x[0] <= edge ? 0.5 - limit_graded(1.0 - in, 0.5, c->growth[0])
                      : 0.5 + limit_graded(out, c->wide - 0.5, c->growth[1]);
  x[1] = -limit_graded(1.0 - x[1], c->deep, c->growth[2]);
}

static inline pw_status limit_start(solid *s, const limit_case *c, solid_map *map)
{
  pw_tet_box box = {.bricks = {c->bricks[0], c->bricks[1], 1}, .high = {1.0, 1.0, c->thick}};
  box.per_brick = c->per_brick;
  box.nodes = 10;
  memset(s, 0, sizeof *s);
  s->material = solid_von_mises(c->young, c->poisson, c->yield);
  PW_TRY(solid_mesh(&box, map, c, &s->mesh));
  PW_TRY(solid_start(s, c->fbar, 1, NULL));
  solid_hold(s, 2, 2, 0.0, 1e-9 * c->thick);
  solid_hold(s, 2, 2, c->thick, 1e-9 * c->thick);
  return PW_OK;
}

/** Component @p comp of nodes at @p y with x up to @p most moves by @p push in a step. */
static inline void limit_push(solid *s, int comp, double y, double most, double push)
{
  const pw_idx n = s->nnode;
  for (pw_idx a = 0; a < n; a++) {
    if (fabs(s->x[n + a] - y) < 1e-9 && s->x[a] < most + 1e-9) {
      s->model.fixed[comp * n + a] = 1;
      s->push[comp * n + a] = push;
    }
  }
}

/** Strip footing on weightless soil, going down by @p push in a step. */
static inline pw_status limit_footing_start(solid *s, const limit_case *c, double push)
{
  PW_TRY(limit_start(s, c, limit_strip_map));
  solid_hold(s, 0, 0, 0.0, 1e-9);
  solid_hold(s, 0, 0, c->wide, 1e-9);
  for (int comp = 0; comp < 3; comp++) {
    solid_hold(s, comp, 1, -c->deep, 1e-9);
  }
  limit_push(s, 1, 0.0, 0.5, -push);
  if (c->rough) {
    limit_push(s, 0, 0.0, 0.5, 0.0);
  }
  return PW_OK;
}

/** A quarter of a bar between deep notches: the ligament of width 1 at y = 0, the far end pulled. */
static inline pw_status limit_notch_start(solid *s, const limit_case *c, double push)
{
  PW_TRY(limit_start(s, c, limit_strip_map));
  solid_hold(s, 0, 0, 0.0, 1e-9);
  limit_push(s, 1, 0.0, 0.5, 0.0);
  limit_push(s, 1, -c->deep, c->wide, -push);
  return PW_OK;
}

/** Mean pressure on the strip or ligament over (2 + pi) times the shear strength. */
static inline double limit_strip_ratio(const solid *s, const limit_case *c, double push)
{
  const double limit = (2.0 + acos(-1.0)) * c->yield / sqrt(3.0);
  return solid_work(s, s->push) / push / (0.5 * c->thick) / limit;
}

typedef pw_status limit_strip_start(solid *s, const limit_case *c, double push);

/** What a run of limit_strip_run() ends with. */
typedef struct limit_result {
  double load;  /* over the limit */
  double slope; /* of the last step over that of the first */
  pw_idx tets;
  pw_off crossed; /* points that have changed elements */
  int cuts;       /* of steps from the fourth on */
} limit_result;

static inline pw_status limit_strip_run(limit_strip_start *start, const limit_case *c, double push,
                                        int steps, limit_result *out)
{
  static solid s;
  double first = 0.0, before = 0.0;
  memset(out, 0, sizeof *out);
  PW_TRY(start(&s, c, push));
  for (int k = 0; k < steps; k++) {
    before = out->load;
    PW_TRY(solid_step(&s, 0.0));
    out->load = limit_strip_ratio(&s, c, push);
    first = k == 0 ? out->load : first;
    out->crossed += s.model.walked.moved;
    out->cuts += k < 3 ? 0 : s.report.cuts;
  }
  out->slope = (out->load - before) / first;
  out->tets = s.mesh.tets.nelem;
  solid_end(&s);
  return PW_OK;
}

/** Meshes of `level` 1, 2, ...; E/c_u = 1e5, so that the limit is reached before points cross. */
static inline limit_case limit_footing_case(int level, pw_fbar fbar)
{
  const double growth = 2.3 + 0.35 * (level - 1);
  return (limit_case){.bricks = {14 * level, 7 * level},
                      .per_brick = 6,
                      .fbar = fbar,
                      .thick = 0.2 / level,
                      .young = 1e5,
                      .poisson = 0.49,
                      .yield = sqrt(3.0),
                      .under = 6 * level,
                      .growth = {growth, growth + 0.5, growth + 0.2},
                      .wide = 3.0,
                      .deep = 1.5};
}

/** Usual shape and Poisson's ratio, but E/yield = 1e5 for the same reason. */
static inline limit_case limit_notch_case(int level, pw_fbar fbar)
{
  limit_case c = limit_footing_case(level, fbar);
  c.bricks[0] = 14 * level;
  c.bricks[1] = 10 * level;
  c.under = 5 * level;
  c.poisson = 0.29;
  c.yield = 1.0;
  c.growth[1] = c.growth[2] = c.growth[0] + 2.2;
  c.wide = 5.0;
  c.deep = 15.0;
  return c;
}

#endif /* PW_TESTS_LIMIT_PROBLEMS_H */
