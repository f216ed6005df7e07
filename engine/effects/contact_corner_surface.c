/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/contact_corner_surface.h"

#include <math.h>

#include "engine/core/mem.h"

static const pw_real PI = PW_PI;
/* Of 1 + cos(turn) at a vertex: sharper ones are cut off. */
static const pw_real SHARPEST = 0.1;
/* Part of a segment that the rounding of its ends may take. */
static const pw_real MOST = 0.75;
/* Sine of a turn that rounding makes of a straight line. */
static const pw_real STRAIGHT = 1e-9;
/* Beyond the free end of a line by this part of a segment there is no contact. */
static const pw_real OVER_END = 0.01;

/* Normal and length of segment k. */
static pw_real normal_of(const pw_interface *line, pw_idx k, pw_real *n)
{
  const pw_real *a = line->node[k].x, *b = line->node[pw_interface_next(line, k)].x;
  pw_real tx = b[0] - a[0], ty = b[1] - a[1], l = sqrt(tx * tx + ty * ty);
  n[0] = ty / l;
  n[1] = -tx / l;
  return l;
}

/* Normals before and after node k; on the axis the other side is the mirror image, at a free end
 * both are the same. */
static void normals_at(const pw_interface *line, pw_idx k, pw_real *before, pw_real *after)
{
  const bool first = !line->closed && k == 0, last = !line->closed && k == line->n - 1;
  if (!first) {
    normal_of(line, k > 0 ? k - 1 : line->n - 1, before);
  }
  if (!last) {
    normal_of(line, k, after);
  }
  pw_real *to = first ? before : after;
  const pw_real *from = first ? after : before;
  if (first || last) {
    to[0] = line->node[k].axis ? -from[0] : from[0];
    to[1] = from[1];
  }
}

/* tan(turn / 2) of the line at node k, positive where it is convex. */
static pw_real half_turn(const pw_interface *line, pw_idx k)
{
  pw_real a[2] = {0.0, 0.0}, b[2] = {0.0, 0.0};
  normals_at(line, k, a, b);
  return (a[0] * b[1] - a[1] * b[0]) / pw_max(1.0 + a[0] * b[0] + a[1] * b[1], SHARPEST);
}

static void move_inwards(pw_round_line *r)
{
  const pw_interface *line = r->line;
  for (pw_idx k = 0; k < line->n; k++) {
    pw_real a[2] = {0.0, 0.0}, b[2] = {0.0, 0.0};
    normals_at(line, k, a, b);
    pw_real by = r->rounding / pw_max(1.0 + a[0] * b[0] + a[1] * b[1], SHARPEST);
    for (int c = 0; c < 2; c++) {
      r->inner.node[k].x[c] = line->node[k].x[c] - by * (a[c] + b[c]);
    }
  }
}

/* Whether the inner line now is convex and goes all around or from axis to axis. */
static bool is_convex(const pw_interface *line)
{
  bool convex = line->closed || (line->node[0].axis && line->node[line->n - 1].axis);
  for (pw_idx k = 0; k < line->n && convex; k++) {
    pw_real a[2] = {0.0, 0.0}, b[2] = {0.0, 0.0};
    normals_at(line, k, a, b);
    convex = a[0] * b[1] - a[1] * b[0] > -STRAIGHT && a[0] * b[0] + a[1] * b[1] > -1.0 + STRAIGHT;
  }
  return convex;
}

/* The largest rounding at which no inner segment becomes too short. */
static pw_real limit_rounding(const pw_interface *line, pw_real rounding)
{
  for (pw_idx k = 0; k < pw_interface_segments(line); k++) {
    pw_real n[2], l = normal_of(line, k, n);
    pw_real taken = half_turn(line, k) + half_turn(line, pw_interface_next(line, k));
    if (taken * rounding > MOST * l) {
      rounding = MOST * l / taken;
    }
  }
  return rounding;
}

/* Places along the surface of the start; arcs at convex vertices count. */
static void measure(pw_round_line *r)
{
  pw_real arc = r->rounding * PI;
  for (pw_idx k = 0; k < pw_interface_segments(&r->inner); k++) {
    pw_real n[2];
    r->length[k] = normal_of(&r->inner, k, n);
    r->arc[k] = arc;
    pw_real turn = 2.0 * atan(half_turn(r->line, pw_interface_next(r->line, k)));
    arc += r->length[k] + r->rounding * pw_max(turn, 0.0);
  }
  r->total = arc - r->arc[0];
}

static pw_status build(pw_round_line *r, const pw_mesh *mesh)
{
  const pw_interface *line = r->line;
  pw_real *xy = NULL;
  PW_TRY(pw_mem_alloc("inner line", 2 * (pw_off)line->n, sizeof(pw_real), &xy));
  for (pw_idx k = 0; k < line->n; k++) {
    xy[2 * k] = line->node[k].x[0];
    xy[2 * k + 1] = line->node[k].x[1];
  }
  pw_status status =
      pw_interface_create(xy, NULL, line->n, line->closed, line->axi, line->n, &r->inner);
  pw_mem_free(&xy);
  PW_TRY(status);
  PW_TRY(pw_bins_create(&r->inner, mesh, &r->bins));
  PW_TRY(pw_mem_alloc("surface arcs", line->n, sizeof(pw_real), &r->arc));
  PW_TRY(pw_mem_alloc("surface lengths", line->n, sizeof(pw_real), &r->length));
  move_inwards(r);
  measure(r);
  return PW_OK;
}

pw_status pw_round_line_create(const pw_interface *line, pw_real rounding, const pw_mesh *mesh,
                               pw_round_line *out)
{
  pw_round_line r = {.line = line, .rounding = limit_rounding(line, rounding)};
  pw_status status = build(&r, mesh);
  if (status != PW_OK) {
    pw_round_line_destroy(&r);
    return status;
  }
  *out = r;
  return PW_OK;
}

void pw_round_line_destroy(pw_round_line *r)
{
  pw_interface_destroy(&r->inner);
  pw_bins_destroy(&r->bins);
  pw_mem_free(&r->arc);
  pw_mem_free(&r->length);
}

void pw_round_line_update(pw_round_line *r, const pw_mesh *mesh)
{
  const pw_interface *line = r->line;
  for (int c = 0; c < 2; c++) {
    r->box[2 * c] = r->box[2 * c + 1] = line->node[0].x[c];
    for (pw_idx k = 1; k < line->n; k++) {
      r->box[2 * c] = pw_min(r->box[2 * c], line->node[k].x[c]);
      r->box[2 * c + 1] = pw_max(r->box[2 * c + 1], line->node[k].x[c]);
    }
  }
  move_inwards(r);
  r->convex = is_convex(&r->inner);
  pw_interface_locate(&r->inner, mesh);
  pw_bins_fill(&r->bins, &r->inner);
}

/* Place of x beside an end of the line that is neither closed nor on the axis. */
static bool over_free_end(const pw_round_line *r, pw_idx segment, const pw_pair *pair,
                          const pw_real *x)
{
  const pw_interface *line = &r->inner;
  const bool first = pair->xi <= 0.0;
  pw_idx end = first ? segment : pw_interface_next(line, segment);
  if (line->closed || line->node[end].axis || (end != 0 && end != line->n - 1)) {
    return false;
  }
  pw_real n[2], l = normal_of(line, segment, n);
  pw_real along = -n[1] * (x[0] - line->node[end].x[0]) + n[0] * (x[1] - line->node[end].x[1]);
  return (first ? -along : along) > OVER_END * l;
}

static pw_real arc_of(const pw_round_line *r, pw_idx segment, const pw_pair *pair)
{
  pw_real start = r->arc[segment], n[2];
  if (pair->gap <= 0.0 || (pair->xi > 0.0 && pair->xi < 1.0)) {
    return start + pair->xi * r->length[segment];
  }
  normal_of(&r->inner, segment, n);
  pw_real turn =
      atan2(fabs(n[0] * pair->n[1] - n[1] * pair->n[0]), n[0] * pair->n[0] + n[1] * pair->n[1]);
  return pair->xi <= 0.0 ? start - r->rounding * turn
                         : start + r->length[segment] + r->rounding * turn;
}

static void set_place(const pw_round_line *r, pw_idx segment, const pw_pair *pair, const pw_real *x,
                      pw_round_place *place)
{
  const pw_real *a = r->line->node[segment].x;
  const pw_real *b = r->line->node[pw_interface_next(r->line, segment)].x;
  pw_pair own = pw_pair_project(x, a, b);
  bool over = (pair->xi <= 0.0 || pair->xi >= 1.0) && over_free_end(r, segment, pair, x);
  *place = (pw_round_place){.segment = segment,
                            .gap = over ? PW_HUGE : pair->gap - r->rounding,
                            .n = {pair->n[0], pair->n[1]},
                            .t = {-pair->n[1], pair->n[0]},
                            .arc = arc_of(r, segment, pair),
                            .xi = pw_min(pw_max(own.xi, 0.0), 1.0)};
}

void pw_round_line_place(const pw_round_line *r, pw_idx segment, const pw_real *x,
                         pw_round_place *place)
{
  pw_pair pair;
  pw_interface_closest(&r->inner, segment, x, &pair);
  set_place(r, segment, &pair, x, place);
}

bool pw_round_line_near(const pw_round_line *r, const pw_real *x, pw_idx cell, pw_real reach,
                        pw_round_place *place)
{
  pw_idx owner = pw_bins_nearest(&r->bins, &r->inner, reach, cell, x);
  if (owner < 0) {
    return false;
  }
  pw_round_line_place(r, owner, x, place);
  return true;
}

bool pw_round_line_find(const pw_round_line *r, const pw_real *x, pw_idx cell, pw_real reach,
                        pw_round_place *place)
{
  return pw_round_line_near(r, x, cell, reach, place) && place->gap < 0.0;
}

/* Segment whose place along the surface is the last that is not beyond arc. */
static pw_idx segment_at(const pw_round_line *r, pw_real arc)
{
  pw_idx low = 0, high = pw_interface_segments(&r->inner);
  while (high - low > 1) {
    pw_idx middle = low + (high - low) / 2;
    *(r->arc[middle] <= arc ? &low : &high) = middle;
  }
  return low;
}

/* Along the line from a segment on, while that is nearer. */
static void track(const pw_round_line *r, pw_idx from, const pw_real *x, pw_round_place *place)
{
  pw_pair pair;
  pw_idx owner = pw_interface_track(&r->inner, from, x, &pair);
  set_place(r, owner, &pair, x, place);
}

void pw_round_line_follow(const pw_round_line *r, pw_real arc, const pw_real *x,
                          pw_round_place *place)
{
  track(r, segment_at(r, arc), x, place);
}

/* Where x lies in front of the line, along its normal, a convex body has no place that is nearer. */
bool pw_round_line_seek(const pw_round_line *r, pw_idx from, const pw_real *x,
                        pw_round_place *place)
{
  if (r->convex) {
    track(r, from, x, place);
  }
  return r->convex && place->gap > 0.0;
}
