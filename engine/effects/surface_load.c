/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/surface_load.h"

#include <math.h>

#include "engine/bodies.h"
#include "engine/core/mem.h"
#include "engine/effects/common.h"
#include "engine/effects/params.h"

static const pw_real corner_s[4] = {-1.0, 1.0, 1.0, -1.0};
static const pw_real corner_t[4] = {-1.0, -1.0, 1.0, 1.0};

/* Corner c of a domain with centre (x, y) and half-side vectors h. */
static void corner_at(const pw_real *x, const pw_real *h, int c, pw_real *out)
{
  out[0] = x[0] + corner_s[c] * h[0] + corner_t[c] * h[2];
  out[1] = x[1] + corner_s[c] * h[1] + corner_t[c] * h[3];
}

static void initial_corner(const pw_domains *d, pw_idx i, int c, pw_real *out)
{
  pw_real x[2] = {d->x[i], d->x[d->n + i]}, h[4];
  for (int k = 0; k < 4; k++) {
    h[k] = d->half[(pw_off)k * d->n + i];
  }
  corner_at(x, h, c, out);
}

/* Extent of body b: {left, right, bottom, top}. */
static void bounding_box(const pw_domains *d, int b, pw_real *box)
{
  box[0] = box[2] = PW_HUGE;
  box[1] = box[3] = -PW_HUGE;
  for (pw_idx i = 0; i < d->n; i++) {
    for (int c = 0; c < 4 && d->body[i] == b; c++) {
      pw_real x[2];
      initial_corner(d, i, c, x);
      for (pw_off a = 0; a < 2; a++) {
        box[2 * a] = pw_min(box[2 * a], x[a]);
        box[2 * a + 1] = pw_max(box[2 * a + 1], x[a]);
      }
    }
  }
}

/* First corner of the edge of domain i that lies at coordinate `at` of the axis across the face,
 * with its ends along the face; -1 when it has none. */
static int edge_on_face(const pw_domains *d, pw_idx i, int along, const pw_real *at, pw_real *ends)
{
  for (int c = 0; c < 4; c++) {
    pw_real a[2], b[2];
    initial_corner(d, i, c, a);
    initial_corner(d, i, (c + 1) % 4, b);
    if (fabs(a[1 - along] - at[0]) <= at[1] && fabs(b[1 - along] - at[0]) <= at[1]) {
      ends[0] = pw_min(a[along], b[along]);
      ends[1] = pw_max(a[along], b[along]);
      return c;
    }
  }
  return -1;
}

/* Measure of a piece of the face: its length, or the integral of r over it. */
static pw_real measure(const pw_sim *sim, int along, pw_real radius, const pw_real *ends)
{
  pw_real length = ends[1] - ends[0];
  if (sim->scene.geometry != PW_AXI) {
    return length;
  }
  return length * (along == 0 ? 0.5 * (ends[0] + ends[1]) : radius);
}

/* Count the edges on the face, or store them when `out` has its arrays. */
static pw_idx collect(const pw_sim *sim, const pw_domains *d, int b, const pw_real *at,
                      pw_surface_load *out)
{
  pw_idx n = 0;
  pw_real sum = 0.0, face[2] = {PW_HUGE, -PW_HUGE};
  for (pw_idx i = 0; i < d->n; i++) {
    pw_real ends[2];
    int c = d->body[i] == b ? edge_on_face(d, i, out->along, at, ends) : -1;
    if (c < 0) {
      continue;
    }
    sum += measure(sim, out->along, at[0], ends);
    face[0] = pw_min(face[0], ends[0]);
    face[1] = pw_max(face[1], ends[1]);
    if (out->id) {
      out->id[n] = i;
      out->corner[n] = c;
      out->length[n] = ends[1] - ends[0];
    }
    n++;
  }
  pw_real whole = n > 0 ? measure(sim, out->along, at[0], face) : 0.0;
  out->share = sum > whole * (1.0 + 1e-9) ? whole / sum : 1.0;
  return n;
}

static pw_status allocate(pw_surface_load *load)
{
  PW_TRY(pw_mem_alloc("loaded edges: points", load->n, sizeof(pw_idx), &load->id));
  PW_TRY(pw_mem_alloc("loaded edges: corners", load->n, sizeof(pw_idx), &load->corner));
  PW_TRY(pw_mem_alloc("loaded edges: lengths", load->n, sizeof(pw_real), &load->length));
  PW_TRY(pw_mem_alloc("loaded edges: nodes", (pw_off)load->n * PW_EDGE_NODES, sizeof(pw_idx),
                      &load->node));
  return pw_mem_alloc("loaded edges: forces", (pw_off)load->n * PW_EDGE_NODES, sizeof(pw_real),
                      &load->force);
}

static pw_status find_edges(const pw_sim *sim, const pw_domains *d, int b, int side,
                            pw_surface_load *out)
{
  /* d lists the initial domains in the order of the points' ids. */
  PW_REQUIRE(d->n == sim->points.n, PW_ERR_ARGUMENT, "%d domains for %d points", d->n,
             sim->points.n);
  pw_real box[4];
  bounding_box(d, b, box);
  pw_real place = box[side == PW_SIDE_BOTTOM ? 2
                      : side == PW_SIDE_TOP  ? 3
                      : side == PW_SIDE_LEFT ? 0
                                             : 1];
  out->along = side == PW_SIDE_BOTTOM || side == PW_SIDE_TOP ? 0 : 1;
  out->normal = side == PW_SIDE_BOTTOM || side == PW_SIDE_LEFT ? 1.0 : -1.0;
  out->field = sim->body[b].field;
  pw_real at[2] = {place, 1e-6 * sim->mesh.cell};
  out->n = collect(sim, d, b, at, out);
  PW_REQUIRE(out->n > 0, PW_ERR_SCENE, "no flat edge on the loaded side of body '%s'",
             sim->body[b].name);
  PW_TRY(allocate(out));
  collect(sim, d, b, at, out);
  return PW_OK;
}

pw_status pw_surface_load_create(pw_sim *sim, int b, int side, pw_surface_load *out)
{
  pw_domains d = {0};
  *out = (pw_surface_load){0};
  PW_TRY(pw_domains_create(&sim->scene, &d));
  pw_status status = find_edges(sim, &d, b, side, out);
  pw_domains_destroy(&d);
  if (status != PW_OK) {
    pw_surface_load_destroy(out);
  }
  return status;
}

void pw_surface_load_destroy(pw_surface_load *load)
{
  pw_mem_free(&load->id);
  pw_mem_free(&load->corner);
  pw_mem_free(&load->length);
  pw_mem_free(&load->node);
  pw_mem_free(&load->force);
  *load = (pw_surface_load){0};
}

/* Present ends of edge e, and its length along the face. */
static pw_real edge_ends(const pw_sim *sim, const pw_surface_load *load, pw_idx e, pw_real *a,
                         pw_real *b)
{
  const pw_points *p = &sim->points;
  pw_idx i = p->slot[load->id[e]];
  pw_real x[2] = {p->x[i], p->x[p->ld + i]}, h[4];
  if (!p->half) {
    a[0] = b[0] = x[0];
    a[1] = b[1] = x[1];
    return load->length[e];
  }
  for (int k = 0; k < 4; k++) {
    h[k] = p->half[(pw_off)k * p->ld + i];
  }
  corner_at(x, h, load->corner[e], a);
  corner_at(x, h, (load->corner[e] + 1) % 4, b);
  return fabs(b[load->along] - a[load->along]);
}

pw_real pw_surface_load_apply(pw_sim *sim, pw_surface_load *load, pw_real pressure)
{
  pw_real *rec = pw_nodes_field(&sim->nodes, load->field);
  pw_real total = 0.0;
  for (pw_idx e = 0; e < load->n; e++) {
    pw_real end[2][2];
    pw_real force = load->share * pressure * edge_ends(sim, load, e, end[0], end[1]);
    pw_idx *node = load->node + (pw_off)e * PW_EDGE_NODES;
    pw_real *f = load->force + (pw_off)e * PW_EDGE_NODES;
    for (pw_off k = 0; k < 2; k++) {
      /* Integral of r times the edge's linear shape function of this end. */
      pw_real r = (2.0 * end[k][0] + end[1 - k][0]) / 6.0;
      pw_real part = force * (sim->scene.geometry == PW_AXI ? pw_max(r, 0.0) : 0.5);
      pw_mesh_shape(&sim->mesh, end[k], node + 4 * k, f + 4 * k);
      for (int j = 0; j < 4; j++) {
        f[4 * k + j] *= part;
        total += f[4 * k + j];
        rec[(pw_off)node[4 * k + j] * PW_NODE + PW_NODE_FORCE + 1 - load->along] +=
            load->normal * f[4 * k + j];
      }
    }
  }
  return total * sim->measure;
}

pw_real pw_surface_load_work(const pw_sim *sim, const pw_surface_load *load)
{
  const pw_real *rec = pw_nodes_field(&sim->nodes, load->field);
  pw_real power = 0.0;
  for (pw_off k = 0; k < (pw_off)load->n * PW_EDGE_NODES; k++) {
    const pw_real *r = rec + (pw_off)load->node[k] * PW_NODE;
    power += load->force[k] * pw_node_mean_velocity(sim, r, 1 - load->along);
  }
  return power * load->normal * sim->measure * sim->dt;
}
