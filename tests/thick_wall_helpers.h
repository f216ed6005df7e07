/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file tests/thick_wall_helpers.h
 * @brief Thick cylinders and spheres whose bore is widened by prescribed displacements.
 *
 * A quarter of the cylinder is a slab one brick thick between rollers. Faces are
 * flat, so that the bore is a polygon or polyhedron; corners stand out as far as gives it the area or
 * volume of the round one. It widens in proportion, and the pressure is the work of all forces over
 * the change of its area or volume.
 */
#ifndef PW_TESTS_THICK_WALL_HELPERS_H
#define PW_TESTS_THICK_WALL_HELPERS_H

#include "tests/sphere_mesh.h"

typedef struct wall_case {
  bool sphere;
  pw_idx radial, round; /* bricks or shells through the wall, bricks or triangles along the bore */
  pw_fbar fbar;
  double inner, outer;          /* m */
  double growth;                /* log of the last over the first brick's height */
  double thick;                 /* of the slab; m */
  double young, poisson, yield; /* Pa, -, Pa: the yield of a uniaxial test */
} wall_case;

static inline double wall_radius(const wall_case *c, double part)
{
  const double size = c->outer - c->inner;
  const double from =
      c->growth > 0.0 ? size * expm1(c->growth * part) / expm1(c->growth) : size * part;
  return c->inner + from;
}

/** x[0] of the unit square along the radius, x[1] around. */
static inline void wall_map(const void *ctx, pw_real *x)
{
  const wall_case *c = ctx;
  const double r = wall_radius(c, x[0]), angle = 0.5 * acos(-1.0) * x[1];
  x[0] = x[1] == 1.0 ? 0.0 : r * cos(angle);
  x[1] = r * sin(angle);
}

/** -1 for a node of the bore, 1 for one of the outer face, else 0. Middles of edges lie on chords:
 *  the first layer of nodes beyond is taken to be further away than those sag. */
static inline int wall_on_face(const solid *s, const wall_case *c, pw_idx a)
{
  const pw_idx n = s->nnode;
  const double x = s->x[a], y = s->x[n + a], z = c->sphere ? s->x[2 * n + a] : 0.0;
  const double r = sqrt(x * x + y * y + z * z), angle = 0.25 * acos(-1.0) / c->round;
  const double sag = c->sphere ? 2.5 * (1.0 - cos(angle)) : 1.0 - cos(angle);
  return r < c->inner * (1.0 + 1e-9) ? -1 : r > c->outer * (1.0 - sag - 1e-9);
}

/** The bore widens by @p push in a step. */
static inline pw_status wall_start(solid *s, const wall_case *c, double push)
{
  s->material = solid_von_mises(c->young, c->poisson, c->yield);
  if (c->sphere) {
    double radius[200];
    PW_REQUIRE(2 * c->radial < 200, PW_ERR_ARGUMENT, "%d shells", (int)c->radial);
    for (pw_idx l = 0; l <= 2 * c->radial; l++) {
      radius[l] = wall_radius(c, 0.5 * l / c->radial);
    }
    sphere_shape shape = {.radial = c->radial, .round = c->round, .radius = radius};
    PW_TRY(sphere_mesh(&shape, &s->mesh));
  } else {
    pw_tet_box box = {.bricks = {c->radial, c->round, 1}, .high = {1.0, 1.0, c->thick}};
    box.per_brick = 6;
    box.nodes = 10;
    PW_TRY(solid_mesh(&box, wall_map, c, &s->mesh));
  }
  PW_TRY(solid_start(s, c->fbar, 1, NULL));
  const pw_idx n = s->nnode, dim = c->sphere ? 3 : 2;
  for (int k = 0; k < 3; k++) {
    solid_hold(s, k, k, 0.0, 1e-9 * c->inner);
  }
  if (!c->sphere) {
    solid_hold(s, 2, 2, c->thick, 1e-9 * c->thick);
  }
  for (pw_idx a = 0; a < n; a++) {
    for (pw_idx k = 0; k < dim && wall_on_face(s, c, a) < 0; k++) {
      s->model.fixed[k * n + a] = 1;
      s->push[k * n + a] = push / c->inner * s->x[k * n + a];
    }
  }
  return PW_OK;
}

/** Sums over the faces of the bore, or the outer ones, of x . n A / 3 and u . n A of their corners. */
static inline void wall_faces(const solid *s, const wall_case *c, bool outer, const double *u,
                              double *sums)
{
  const pw_tets *t = &s->mesh.tets;
  const pw_idx n = t->nnode;
  sums[0] = sums[1] = 0.0;
  for (pw_idx l = 0; l < s->mesh.nface; l++) {
    const pw_idx *node = t->node + 4 * (s->mesh.face[l] / 4);
    double x[3][3], d[3] = {0.0, 0.0, 0.0};
    bool on = true;
    for (int i = 0; i < 3; i++) {
      const pw_idx a = node[pw_tet_face[s->mesh.face[l] % 4][i]];
      on = on && wall_on_face(s, c, a) == (outer ? 1 : -1);
      for (pw_idx k = 0; k < 3; k++) {
        x[i][k] = s->x[k * n + a];
        d[k] += u ? u[k * n + a] / 3.0 : 0.0;
      }
    }
    const double area[3] = {0.5 * ((x[1][1] - x[0][1]) * (x[2][2] - x[0][2]) -
                                   (x[1][2] - x[0][2]) * (x[2][1] - x[0][1])),
                            0.5 * ((x[1][2] - x[0][2]) * (x[2][0] - x[0][0]) -
                                   (x[1][0] - x[0][0]) * (x[2][2] - x[0][2])),
                            0.5 * ((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) -
                                   (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]))};
    for (int k = 0; on && k < 3; k++) {
      sums[0] += area[k] * x[0][k] / 3.0;
      sums[1] += area[k] * d[k];
    }
  }
}

/** Pressure in the bore once its nodes stand at 1 + @p wider times where they were at the start of
 *  the step; Pa. */
static inline double wall_pressure(const solid *s, const wall_case *c, double push, double wider)
{
  const double growth = c->sphere ? (1.0 + wider) * (1.0 + wider) : 1.0 + wider;
  double sums[2];
  wall_faces(s, c, false, NULL, sums);
  return solid_work(s, s->push) / (-3.0 * sums[0] * growth * push / c->inner);
}

/** Displacement of the outer face along the radius that gives its change of volume; m. */
static inline double wall_outside(const solid *s, const wall_case *c, const double *u)
{
  double sums[2];
  wall_faces(s, c, true, u, sums);
  return c->outer * sums[1] / (3.0 * sums[0]);
}

/** a = 0.1 m, b = 0.2 m, E = 210 GPa, nu = 0.3, yield 0.24 GPa, @p n bricks through the wall. */
static inline wall_case wall_steel(bool sphere, pw_idx n, pw_fbar fbar)
{
  return (wall_case){.sphere = sphere,
                     .radial = n,
                     .round = sphere ? (5 * n + 2) / 4 : (pw_idx)ceil(0.75 * acos(-1.0) * n - 1e-9),
                     .fbar = fbar,
                     .inner = 0.1,
                     .outer = 0.2,
                     .thick = 0.1 / (double)n,
                     .young = 210e9,
                     .poisson = 0.3,
                     .yield = 0.24e9};
}

/** A cavity of radius 1 in a body that hardly changes its volume, c_u = 1: von Mises where two
 *  stresses are equal, or in plane strain. The body ends at four radii of
 *  the plastic zone, 3.2 around a sphere. */
static inline wall_case wall_cavity(bool sphere, double rigidity, pw_fbar fbar)
{
  const double outer = sphere ? 3.2 * cbrt(rigidity) : 4.0 * sqrt(rigidity);
  return (wall_case){.sphere = sphere,
                     .radial = 12,
                     .round = sphere ? 3 : 5,
                     .fbar = fbar,
                     .inner = 1.0,
                     .outer = outer,
                     .growth = log(outer) + (sphere ? 0.6 : 0.3),
                     .thick = 0.3,
                     .young = 2.0 * rigidity * 1.49,
                     .poisson = 0.49,
                     .yield = sphere ? 2.0 : sqrt(3.0)};
}

/** Open a cavity to twice its volume in one step. @param[out] pressure then; Pa */
static inline pw_status wall_double(solid *s, const wall_case *c, double *pressure)
{
  const double wider = (c->sphere ? cbrt(2.0) : sqrt(2.0)) - 1.0;
  memset(s, 0, sizeof *s);
  s->approach = 12;
  s->line_search = 4;
  PW_TRY(wall_start(s, c, wider * c->inner));
  PW_TRY(solid_step(s, 0.0));
  *pressure = wall_pressure(s, c, wider * c->inner, wider);
  return PW_OK;
}

#endif /* PW_TESTS_THICK_WALL_HELPERS_H */
