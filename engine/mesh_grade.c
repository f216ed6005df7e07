/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/mesh_grade.h"

#include <math.h>

enum { MAX_CELLS = 1 << 15 /* along one axis: element and node numbers stay below 2^31 */ };

static const pw_real most_bins = 1 << 20; /* of a graded axis: its length in smallest cells */
static const pw_real huge = 1e300;        /* no limit to a length */
static const pw_real whole = 1e-6;        /* of a cell: lengths that differ by less are the same */

static const pw_real *fine_zone(const pw_grid *g, int a)
{
  return a == 0 ? g->fine_x_m : g->fine_y_m;
}

static bool has_zone(const pw_grid *g, int a)
{
  const pw_real *zone = fine_zone(g, a);
  return zone[0] < zone[1] || zone[0] > zone[1];
}

bool pw_grid_is_graded(const pw_grid *grid)
{
  return has_zone(grid, 0) || has_zone(grid, 1);
}

static pw_real limit_of(const pw_grid *g)
{
  return g->cell_max_m > 0.0 ? g->cell_max_m : huge;
}

/* Length of n cells with the ratio q, or of as many as it takes to pass `enough`. */
static pw_real length_of(const pw_grid *g, pw_real q, pw_idx n, pw_real enough, pw_idx *used)
{
  pw_real size = g->cell_m, limit = limit_of(g), sum = 0.0;
  pw_idx k = 0;
  while (k < n && sum < enough) {
    size = pw_min(size * q, limit);
    sum += size;
    k++;
  }
  *used = k;
  return sum;
}

/* Divide a side of the given length. */
static pw_status plan_side(const pw_grid *g, int a, pw_real length, pw_idx *cells, pw_real *ratio)
{
  const pw_real slack = whole * g->cell_m;
  pw_idx n, used;
  *cells = 0;
  *ratio = 1.0;
  if (length <= slack) {
    return PW_OK;
  }
  pw_real most = length_of(g, g->growth, MAX_CELLS, length - slack, &n);
  PW_REQUIRE(most >= length - slack, PW_ERR_SCENE, "cell_m = %g m: more than %d cells along %s",
             g->cell_m, MAX_CELLS, a == 0 ? "x" : "y");
  PW_REQUIRE((pw_real)n * g->cell_m <= length + slack, PW_ERR_SCENE,
             "%s leaves %g m beside it, which no whole number of cells with ratios from 1 to "
             "growth = %g can fill: move its edge or raise the growth",
             a == 0 ? "fine_x_m" : "fine_y_m", length, g->growth);
  pw_real lo = 1.0, hi = g->growth;
  for (int k = 0; k < 100; k++) { /* bisection to the last bit; the length rises with q */
    pw_real q = 0.5 * (lo + hi);
    if (length_of(g, q, n, huge, &used) < length) {
      lo = q;
    } else {
      hi = q;
    }
  }
  *cells = n;
  *ratio = hi;
  return PW_OK;
}

static pw_status check_zone(const pw_grid *g, int a)
{
  const pw_real *zone = fine_zone(g, a), lower = g->origin_m[a], upper = lower + g->size_m[a];
  const pw_real slack = whole * g->cell_m;
  const char *key = a == 0 ? "fine_x_m" : "fine_y_m";
  PW_REQUIRE(zone[0] < zone[1], PW_ERR_SCENE, "%s must be written [smaller, larger]", key);
  PW_REQUIRE(zone[0] >= lower - slack && zone[1] <= upper + slack, PW_ERR_SCENE,
             "%s = [%g, %g] leaves the grid, which reaches from %g m to %g m", key, zone[0],
             zone[1], lower, upper);
  PW_REQUIRE(g->growth >= 1.0, PW_ERR_SCENE, "growth = %g is below 1", g->growth);
  PW_REQUIRE(g->size_m[a] / g->cell_m <= most_bins, PW_ERR_SCENE,
             "size_m: %g m are more than %g times cell_m = %g m", g->size_m[a], most_bins,
             g->cell_m);
  pw_real cells = (zone[1] - zone[0]) / g->cell_m;
  PW_REQUIRE(cells >= 1.0 - whole && fabs(cells - round(cells)) <= whole, PW_ERR_SCENE,
             "%s: %g m are not a whole number of cells of %g m", key, zone[1] - zone[0], g->cell_m);
  return PW_OK;
}

pw_status pw_mesh_plan(const pw_grid *g, int a, pw_axis_plan *out)
{
  *out = (pw_axis_plan){.ratio = {1.0, 1.0}, .largest = g->cell_m};
  pw_real length = g->size_m[a], beside[2] = {0.0, 0.0};
  PW_REQUIRE(!(g->cell_max_m > 0.0) || g->cell_max_m >= g->cell_m, PW_ERR_SCENE,
             "cell_max_m = %g m is below cell_m = %g m", g->cell_max_m, g->cell_m);
  if (has_zone(g, a)) {
    const pw_real *zone = fine_zone(g, a);
    PW_TRY(check_zone(g, a));
    length = zone[1] - zone[0];
    beside[0] = zone[0] - g->origin_m[a];
    beside[1] = g->origin_m[a] + g->size_m[a] - zone[1];
  }
  pw_real count = round(length / g->cell_m);
  PW_REQUIRE(count >= 1.0 && fabs(length / g->cell_m - count) <= whole, PW_ERR_SCENE,
             "size_m: the %s %g m is not a whole number of cells of %g m",
             a == 0 ? "width" : "height", length, g->cell_m);
  for (int side = 0; side < 2; side++) {
    PW_TRY(plan_side(g, a, beside[side], &out->outer[side], &out->ratio[side]));
    pw_real last = g->cell_m * pow(out->ratio[side], out->outer[side]);
    out->largest = pw_max(out->largest, pw_min(last, limit_of(g)));
  }
  count += (pw_real)out->outer[0] + (pw_real)out->outer[1];
  PW_REQUIRE(count <= MAX_CELLS, PW_ERR_SCENE, "cell_m = %g m: more than %d cells along one side",
             g->cell_m, MAX_CELLS);
  out->fine = (pw_idx)count - out->outer[0] - out->outer[1];
  return PW_OK;
}

void pw_mesh_grade(const pw_grid *g, int a, const pw_axis_plan *p, pw_real *node)
{
  const pw_idx first = p->outer[0], last = first + p->fine, cells = last + p->outer[1];
  const pw_real lower = has_zone(g, a) ? fine_zone(g, a)[0] : g->origin_m[a];
  const pw_real limit = limit_of(g);
  for (pw_idx k = 0; k <= p->fine; k++) {
    node[first + k] = lower + g->cell_m * (pw_real)k;
  }
  pw_real size = g->cell_m;
  for (pw_idx k = first; k > 0; k--) {
    size = pw_min(size * p->ratio[0], limit);
    node[k - 1] = node[k] - size;
  }
  size = g->cell_m;
  for (pw_idx k = last; k < cells; k++) {
    size = pw_min(size * p->ratio[1], limit);
    node[k + 1] = node[k] + size;
  }
  node[0] = g->origin_m[a];
  node[cells] = g->origin_m[a] + g->size_m[a];
}
