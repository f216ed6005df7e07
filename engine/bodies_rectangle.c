/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A rectangle is tiled regularly with tiles no larger than point_size_m; a tile that overlaps a
 * refine box and is larger than that box asks for is replaced by its four quarters, and so on.
 * Places are computed from whole numbers, tile k of n at level l covering [k, k + 1] / (2^l n) of
 * the side, so neighbours meet exactly and the point on an axis r = 0 has r = its half width.
 */
#include "engine/bodies_shapes.h"

#include <math.h>

static const pw_real same = 1e-9; /* of a tile: a box that only touches it does not refine it */

typedef struct {
  const pw_scene_body *b;
  pw_domain_list *list;
  pw_real tiles[2]; /* tiles along x and y at level 0 */
} tiling;

typedef struct {
  pw_off k[2]; /* place along x and y */
  int level;   /* halvings */
} tile;

/* Half edge and centre of a tile along axis c. */
static pw_real place(const tiling *t, const tile *q, int c, pw_real *centre)
{
  const pw_real *side = c == 0 ? t->b->x_m : t->b->y_m;
  pw_real half = (side[1] - side[0]) / ldexp(t->tiles[c], q->level + 1);
  *centre = side[0] + half * (pw_real)(2 * q->k[c] + 1);
  return half;
}

static bool too_large(const tiling *t, const pw_real *x, const pw_real *half)
{
  for (int r = 0; r < t->b->nrefine; r++) {
    const pw_scene_refine *box = &t->b->refine[r];
    const pw_real *range[2] = {box->x_m, box->y_m};
    bool overlap = true;
    for (int c = 0; c < 2; c++) {
      pw_real reach = half[c] * (1 - same);
      overlap &= x[c] - reach < range[c][1] && x[c] + reach > range[c][0];
    }
    overlap &= box->x_m[1] > box->x_m[0] && box->y_m[1] > box->y_m[0];
    if (overlap && 2 * pw_max(half[0], half[1]) > box->point_size_m * (1 + same)) {
      return true;
    }
  }
  return false;
}

/* Adds a tile, or its quarters; at most 20 levels deep (check_refine in bodies.c). */
static void add_tile(const tiling *t, tile q)
{
  pw_real x[2], half[2];
  for (int c = 0; c < 2; c++) {
    half[c] = place(t, &q, c, &x[c]);
  }
  if (!too_large(t, x, half)) {
    pw_domain_add(t->list, x, (pw_real[]){half[0], 0, 0, half[1]});
    return;
  }
  for (int quarter = 0; quarter < 4; quarter++) {
    add_tile(t, (tile){{2 * q.k[0] + quarter % 2, 2 * q.k[1] + quarter / 2}, q.level + 1});
  }
}

/* Fewest points the boxes can ask for: refuses absurd input before it is walked through. */
static pw_real least_points(const tiling *t)
{
  const pw_scene_body *b = t->b;
  pw_real most = t->tiles[0] * t->tiles[1];
  for (int r = 0; r < b->nrefine; r++) {
    const pw_scene_refine *box = &b->refine[r];
    pw_real w = pw_min(box->x_m[1], b->x_m[1]) - pw_max(box->x_m[0], b->x_m[0]);
    pw_real h = pw_min(box->y_m[1], b->y_m[1]) - pw_max(box->y_m[0], b->y_m[0]);
    most = pw_max(most, pw_max(w, 0) * pw_max(h, 0) / (box->point_size_m * box->point_size_m));
  }
  return most;
}

pw_status pw_body_fill_rectangle(const pw_scene_body *b, pw_domain_list *list)
{
  tiling t = {.b = b,
              .list = list,
              .tiles = {pw_body_pieces(b->x_m[1] - b->x_m[0], b->point_size_m),
                        pw_body_pieces(b->y_m[1] - b->y_m[0], b->point_size_m)}};
  PW_TRY(pw_body_check_count(b, least_points(&t)));
  for (pw_off j = 0; j < (pw_off)t.tiles[1]; j++) {
    for (pw_off i = 0; i < (pw_off)t.tiles[0]; i++) {
      add_tile(&t, (tile){{i, j}, 0});
    }
  }
  return PW_OK;
}
