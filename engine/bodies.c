/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/bodies.h"

#include "engine/bodies_shapes.h"
#include "engine/core/mem.h"

#include <math.h>
#include <string.h>

/* Lengths that differ by less than this part of a cell or of a point are the same length. */
static const pw_real same = 1e-9;
static const pw_real most_points = 1073741824.0; /* 2^30 */

void pw_domains_destroy(pw_domains *d)
{
  pw_mem_free(&d->x);
  pw_mem_free(&d->half);
  pw_mem_free(&d->body);
  d->n = 0;
}

pw_real pw_domain_area(const pw_real *half4)
{
  return fabs(4.0 * (half4[0] * half4[3] - half4[1] * half4[2]));
}

void pw_domain_add(pw_domain_list *list, const pw_real *x, const pw_real *half4)
{
  if (list->hole_radius > 0.0 &&
      hypot(x[0] - list->hole[0], x[1] - list->hole[1]) < list->hole_radius) {
    return;
  }
  pw_off i = list->n++;
  if (!list->out) {
    return;
  }
  pw_off n = list->out->n;
  for (int c = 0; c < 2; c++) {
    list->out->x[c * n + i] = x[c];
  }
  for (int c = 0; c < 4; c++) {
    list->out->half[c * n + i] = half4[c];
  }
  list->out->body[i] = list->body;
}

pw_real pw_body_pieces(pw_real length, pw_real size)
{
  return pw_max(1.0, ceil(length / size - same));
}

pw_status pw_body_check_count(const pw_scene_body *b, pw_real points)
{
  PW_REQUIRE(points <= most_points, PW_ERR_SCENE, "body %s: about %.3g points are more than %.0f",
             b->name, points, most_points);
  return PW_OK;
}

static pw_status check_refine(const pw_scene_body *b)
{
  PW_REQUIRE(b->nrefine == 0 || b->shape == PW_SHAPE_RECTANGLE, PW_ERR_SCENE,
             "body %s: only a rectangle can be refined in boxes", b->name);
  PW_REQUIRE(b->nrefine >= 0 && b->nrefine <= PW_MAX_REFINE, PW_ERR_SCENE,
             "body %s: %d refine boxes, at most %d", b->name, b->nrefine, (int)PW_MAX_REFINE);
  for (int r = 0; r < b->nrefine && b->points_per_cell == 0; r++) {
    pw_real size = b->refine[r].point_size_m;
    PW_REQUIRE(size > 0 && size <= b->point_size_m * (1 + same), PW_ERR_SCENE,
               "body %s: refine box %d asks for points of %g m in a body of points of %g m",
               b->name, r, size, b->point_size_m);
    PW_REQUIRE(size >= ldexp(b->point_size_m, -20), PW_ERR_SCENE,
               "body %s: refine box %d halves points of %g m more than 20 times", b->name, r,
               b->point_size_m);
  }
  return PW_OK;
}

static pw_status check_shape(const pw_scene_body *b, int geometry)
{
  PW_REQUIRE((b->point_size_m > 0 && isfinite(b->point_size_m)) || b->points_per_cell > 0 ||
                 b->kind != PW_BODY_POINTS,
             PW_ERR_SCENE, "body %s: points of %g m", b->name, b->point_size_m);
  PW_REQUIRE(b->points_per_cell == 0 || b->shape == PW_SHAPE_RECTANGLE, PW_ERR_SCENE,
             "body %s: points_per_cell is for rectangles", b->name);
  if (b->shape == PW_SHAPE_RECTANGLE) {
    PW_REQUIRE(b->x_m[1] > b->x_m[0] && b->y_m[1] > b->y_m[0], PW_ERR_SCENE,
               "body %s: the rectangle [%g, %g] x [%g, %g] m is empty", b->name, b->x_m[0],
               b->x_m[1], b->y_m[0], b->y_m[1]);
    return check_refine(b);
  }
  PW_REQUIRE(b->radius_m > 0 && isfinite(b->radius_m), PW_ERR_SCENE, "body %s: a radius of %g m",
             b->name, b->radius_m);
  if (b->shape == PW_SHAPE_RING) {
    PW_TRY(pw_body_check_ring(b));
  }
  if (b->shape == PW_SHAPE_PILE) {
    pw_real tip = pw_pile_tip_height(b);
    PW_REQUIRE(b->length_m > 0 && isfinite(b->length_m), PW_ERR_SCENE, "body %s: a length of %g m",
               b->name, b->length_m);
    PW_REQUIRE(tip <= b->length_m * (1 + same), PW_ERR_SCENE,
               "body %s: a tip of %g m on a pile of %g m", b->name, tip, b->length_m);
    PW_REQUIRE(geometry != PW_AXI || !(fabs(b->centre_m[0]) > 0), PW_ERR_SCENE,
               "body %s: in axisymmetry a pile stands on the axis r = 0, not at %g m", b->name,
               b->centre_m[0]);
  }
  return check_refine(b);
}

static pw_status fill(const pw_scene *scene, pw_domain_list *list)
{
  for (int i = 0; i < scene->nbody; i++) {
    const pw_scene_body *b = &scene->body[i];
    list->body = i;
    list->hole = b->hole_centre_m;
    list->hole_radius = b->hole_radius_m;
    if (b->kind != PW_BODY_POINTS) {
      continue;
    }
    if (b->points_per_cell > 0) {
      PW_TRY(pw_body_fill_cells(b, list->mesh, list));
    } else if (b->shape == PW_SHAPE_RECTANGLE) {
      PW_TRY(pw_body_fill_rectangle(b, list));
    } else if (b->shape == PW_SHAPE_DISC) {
      PW_TRY(pw_body_fill_disc(b, list));
    } else if (b->shape == PW_SHAPE_RING) {
      PW_TRY(pw_body_fill_ring(b, list));
    } else {
      PW_TRY(pw_body_fill_pile(b, (pw_geometry)scene->geometry, list));
    }
    PW_TRY(pw_body_check_count(b, (pw_real)list->n));
  }
  return PW_OK;
}

/* Every corner of every domain must lie in the grid, and at r >= 0 in axisymmetry. */
static pw_status check_corners(const pw_scene *scene, const pw_domains *d)
{
  pw_real slack = same * scene->grid.cell_m;
  for (pw_off i = 0; i < d->n; i++) {
    const char *name = scene->body[d->body[i]].name;
    for (int c = 0; c < 2; c++) {
      pw_real x = d->x[c * d->n + i];
      pw_real reach = fabs(d->half[c * d->n + i]) + fabs(d->half[(2 + c) * d->n + i]);
      pw_real low = scene->grid.origin_m[c], high = low + scene->grid.size_m[c];
      PW_REQUIRE(scene->geometry != PW_AXI || c == 1 || x - reach >= -slack, PW_ERR_SCENE,
                 "body %s: a point at r = %g m reaches over the axis to %g m", name, x, x - reach);
      PW_REQUIRE(x - reach >= low - slack && x + reach <= high + slack, PW_ERR_SCENE,
                 "body %s: a point at %s = %g m, %g m wide, leaves the grid [%g, %g] m", name,
                 c == 0 ? "x" : "y", x, 2 * reach, low, high);
    }
  }
  return PW_OK;
}

static pw_status create(const pw_scene *scene, const pw_mesh *mesh, pw_domains *d)
{
  pw_domain_list list = {.mesh = mesh};
  PW_TRY(fill(scene, &list));
  d->n = (pw_idx)list.n;
  PW_TRY(pw_mem_alloc("domain centres", 2 * list.n, sizeof *d->x, &d->x));
  PW_TRY(pw_mem_alloc("domain half vectors", 4 * list.n, sizeof *d->half, &d->half));
  PW_TRY(pw_mem_alloc("domain bodies", list.n, sizeof *d->body, &d->body));
  list = (pw_domain_list){.out = d, .mesh = mesh};
  PW_TRY(fill(scene, &list));
  return check_corners(scene, d);
}

static bool by_cells(const pw_scene *scene)
{
  for (int i = 0; i < scene->nbody; i++) {
    if (scene->body[i].points_per_cell > 0) {
      return true;
    }
  }
  return false;
}

pw_status pw_domains_create(const pw_scene *scene, pw_domains *out)
{
  for (int i = 0; i < scene->nbody; i++) {
    PW_TRY(check_shape(&scene->body[i], scene->geometry));
  }
  pw_domains d = {.n = 0};
  pw_mesh mesh = {.nelem = 0};
  pw_status s = by_cells(scene) ? pw_mesh_create_grid(&scene->grid, &mesh) : PW_OK;
  if (s == PW_OK) {
    s = create(scene, &mesh, &d);
  }
  pw_mesh_destroy(&mesh);
  if (s != PW_OK) {
    pw_domains_destroy(&d);
    return s;
  }
  *out = d;
  return PW_OK;
}
