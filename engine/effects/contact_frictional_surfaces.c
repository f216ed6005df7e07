/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/contact_frictional.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"

/* With up to so many points a colour one thread is enough. */
enum { FEW_POINTS = 100 };

static pw_node_window window_empty(void)
{
  return (pw_node_window){{INT32_MAX, INT32_MAX}, {-1, -1}};
}

static void window_add(pw_node_window *w, const pw_node_window *other)
{
  for (int a = 0; a < 2; a++) {
    w->low[a] = other->low[a] < w->low[a] ? other->low[a] : w->low[a];
    w->high[a] = other->high[a] > w->high[a] ? other->high[a] : w->high[a];
  }
}

static bool window_meets(const pw_node_window *a, const pw_node_window *b)
{
  return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
         b->low[1] <= a->high[1];
}

/* Nodes within reach of an element, to which its points may scatter until they are sorted anew. */
static pw_node_window window_of(const pw_blocks *b, pw_idx elem)
{
  const pw_idx i = elem % b->cells[0], j = elem / b->cells[0];
  return (pw_node_window){{i - b->reach, j - b->reach}, {i + 1 + b->reach, j + 1 + b->reach}};
}

/* Nodes within reach of the elements of each block. */
static void set_supports(const pw_sim *sim, pw_node_window *support)
{
  const pw_blocks *b = &sim->blocks;
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_node_window w = window_empty();
    for (pw_idx e = b->elem_start[k]; e < b->elem_start[k + 1]; e++) {
      const pw_node_window reach = window_of(b, b->elem[e]);
      window_add(&w, &reach);
    }
    for (int a = 0; a < 2; a++) {
      w.low[a] = w.low[a] > 0 ? w.low[a] : 0;
      w.high[a] = w.high[a] < b->cells[a] ? w.high[a] : b->cells[a];
    }
    support[k] = w;
  }
}

/* List the nodes with mass of both bodies, in their order; returns what they span. */
static pw_node_window list_nodes(pw_contact_surfaces *c)
{
  const pw_sim *sim = c->sim;
  const pw_nodes *nodes = &sim->nodes;
  const int slave = sim->body[c->param->slave].field, master = sim->body[c->param->master].field;
  const pw_real *a = pw_nodes_field(nodes, slave), *b = pw_nodes_field(nodes, master);
  pw_node_window w = window_empty();
  c->count = 0;
  for (pw_idx k = 0; k < nodes->nnode; k++) {
    const pw_off at = (pw_off)k * PW_NODE + PW_NODE_MASS;
    if (!pw_nodes_in_use(nodes, master, k)) {
      k = pw_nodes_group_end(nodes, master, k) - 1;
    } else if (!pw_nodes_in_use(nodes, slave, k)) {
      k = pw_nodes_group_end(nodes, slave, k) - 1;
    } else if (b[at] > sim->mass_cut_off && a[at] > sim->mass_cut_off) {
      const pw_idx i = k % sim->mesh.nodes[0], j = k / sim->mesh.nodes[0];
      c->list[c->count++] = (pw_contact_node){.node = k};
      window_add(&w, &(pw_node_window){{i, j}, {i, j}});
    }
  }
  return w;
}

/* Records of the surface of a body. */
static pw_real *surface_of(const pw_contact_surfaces *c, int body)
{
  const pw_sim *sim = c->sim;
  return c->rec + (pw_off)sim->body[body].field * sim->nodes.nnode * PW_NODE;
}

/* Those of the points [first, end) that can reach a node with both bodies, run by run. */
static void scatter_runs(const pw_contact_surfaces *c, pw_real *surface, pw_idx first, pw_idx end)
{
  const pw_sim *sim = c->sim;
  for (pw_idx k = first; k < end;) {
    pw_idx from = k;
    for (bool near = true; near && k < end; k += near) {
      const pw_node_window reach = window_of(&sim->blocks, sim->points.home[k]);
      near = window_meets(&reach, &c->meeting);
    }
    if (k > from) {
      c->scatter(&sim->transfer, surface, from, k);
    }
    k += k < end; /* that one is too far */
  }
}

static void scatter_surface(void *ctx, pw_idx block)
{
  const pw_contact_surfaces *c = ctx;
  const pw_blocks *b = &c->sim->blocks;
  for (int body = 0; c->near[block] && body < b->nbody; body++) {
    const pw_idx *start = b->point_start + (pw_off)block * b->nbody + body;
    scatter_runs(c, surface_of(c, body), start[0], start[1]);
  }
}

/* Mark the blocks that can reach a node with both bodies; returns how many points they hold. */
static pw_idx mark_near(pw_contact_surfaces *c)
{
  const pw_blocks *b = &c->sim->blocks;
  pw_idx points = 0;
  for (pw_idx k = 0; k < b->nblock; k++) {
    const pw_idx *start = b->point_start + (pw_off)k * b->nbody;
    c->near[k] = window_meets(&c->support[k], &c->meeting);
    points += c->near[k] ? start[b->nbody] - start[0] : 0;
  }
  return points;
}

/* Scatter from the blocks that can reach a node with both bodies. Few points are sooner scattered by
 * one thread, in the order of the colours, than the colours' barriers passed. */
static void scatter_near(pw_contact_surfaces *c, pw_idx points,
                         void (*kernel)(const pw_transfer *t, pw_real *surface, pw_idx first,
                                        pw_idx last))
{
  const pw_blocks *b = &c->sim->blocks;
  c->scatter = kernel;
  if (points > FEW_POINTS * b->ncolour) {
    pw_assemble_coloured(b, c->sim->threads, scatter_surface, c);
    return;
  }
  for (pw_idx k = 0; k < b->nblock; k++) {
    scatter_surface(c, b->colour_block[k]);
  }
}

/* At the nodes with both bodies. The others go on adding up what nobody reads. */
static void clear_surfaces(const pw_contact_surfaces *c)
{
  for (int s = 0; s < 2; s++) {
    pw_real *surface = surface_of(c, s == 0 ? c->param->slave : c->param->master);
    for (pw_idx i = 0; i < c->count; i++) {
      pw_real *at = surface + (pw_off)c->list[i].node * PW_NODE;
      memset(at, 0, PW_SURFACE_ASKS * sizeof *at);
    }
  }
}

/* Unit vector of what the surfaces of slave and master, records @p a and @p b, say together with
 * these shares; false where they say nothing. */
static bool unit_normal(const pw_contact_surfaces *c, pw_idx node, const pw_real *a,
                        const pw_real *b, int normal, pw_real *n)
{
  const pw_mesh *mesh = &c->sim->mesh;
  const bool axi = c->sim->scene.geometry == PW_AXI;
  const pw_idx i = node % mesh->nodes[0], j = node / mesh->nodes[0];
  pw_real r = pw_mesh_node_x(mesh, node), size = mesh->cell;
  pw_real fa = normal != PW_NORMAL_MASTER ? 1.0 : 0.0, fb = normal != PW_NORMAL_SLAVE ? 1.0 : 0.0;
  pw_real nx = fa * a[0] - fb * b[0], ny = fa * a[1] - fb * b[1];
  /* What ends at a side of the grid, or at the axis of symmetry, has no surface there. */
  nx = i == 0 || i == mesh->nodes[0] - 1 ? 0.0 : nx;
  ny = j == 0 || j == mesh->nodes[1] - 1 ? 0.0 : ny;
  size *= axi ? pw_max(r, size) : 1.0;
  pw_real length = sqrt(nx * nx + ny * ny);
  if (length <= 1e-9 * size) {
    return false;
  }
  n[0] = nx / length;
  n[1] = ny / length;
  return true;
}

/* Are the bodies not pulled at a node, along the normal? */
static bool compressed(const pw_real *a, const pw_real *b, const pw_real *n)
{
  return (a[2] + b[2]) * n[0] * n[0] + (a[3] + b[3]) * n[1] * n[1] +
             2.0 * (a[4] + b[4]) * n[0] * n[1] <=
         0.0;
}

static void set_normals(const pw_contact_surfaces *c)
{
  const pw_contact_frictional_param *p = c->param;
  const pw_real *slave = surface_of(c, p->slave), *master = surface_of(c, p->master);
  for (pw_idx i = 0; i < c->count; i++) {
    pw_contact_node *at = &c->list[i];
    const pw_real *a = slave + (pw_off)at->node * PW_NODE, *b = master + (pw_off)at->node * PW_NODE;
    at->facing = unit_normal(c, at->node, a, b, p->normal, at->normal) &&
                 (p->detection == PW_DETECT_CLOSED_GAP || !p->require_compression ||
                  compressed(a, b, at->normal));
  }
}

/* Ask how far both bodies reach towards each other: along the normals of the master and of the slave
 * and along the line that halves their angle. Where one has none, the other's is meant. */
static void ask_extents(const pw_contact_surfaces *c)
{
  pw_real *slave = surface_of(c, c->param->slave), *master = surface_of(c, c->param->master);
  for (pw_idx i = 0; i < c->count; i++) {
    const pw_contact_node *at = &c->list[i];
    pw_real *a = slave + (pw_off)at->node * PW_NODE, *b = master + (pw_off)at->node * PW_NODE;
    if (!at->facing) {
      continue;
    }
    pw_real n[4] = {at->normal[0], at->normal[1], at->normal[0], at->normal[1]};
    unit_normal(c, at->node, a, b, PW_NORMAL_MASTER, n);
    unit_normal(c, at->node, a, b, PW_NORMAL_SLAVE, n + 2);
    const pw_real sum = hypot(n[0] + n[2], n[1] + n[3]);
    for (int k = 0; k < 4; k++) {
      a[k] = n[k];
      b[k] = -a[k];
    }
    /* Of opposite normals the sum is rounding: then there is no line between them. */
    a[4] = b[4] = sum > 0.1 ? 1.0 / sum : 0.0;
    for (int k = PW_SURFACE_EXTENT; k < PW_NODE; k++) {
      a[k] = b[k] = -PW_HUGE;
    }
  }
}

/* The bodies are apart by the largest gap of the three directions. The nodes ask no more. */
static void set_gaps(const pw_contact_surfaces *c)
{
  pw_real *slave = surface_of(c, c->param->slave), *master = surface_of(c, c->param->master);
  for (pw_idx i = 0; i < c->count; i++) {
    pw_contact_node *at = &c->list[i];
    pw_real *a = slave + (pw_off)at->node * PW_NODE, *b = master + (pw_off)at->node * PW_NODE;
    at->gap = 0.0;
    for (int k = PW_SURFACE_EXTENT; at->facing && k < PW_NODE; k++) {
      at->gap = pw_max(at->gap, -(a[k] + b[k]));
    }
    a[PW_SURFACE_ASKS] = b[PW_SURFACE_ASKS] = PW_HUGE;
  }
}

void pw_contact_surfaces_update(pw_contact_surfaces *c)
{
  const pw_kernels *kernels = c->sim->kernels;
  c->meeting = list_nodes(c);
  if (c->count == 0) {
    return;
  }
  const pw_idx points = mark_near(c);
  clear_surfaces(c);
  scatter_near(c, points, kernels->p2g_surface);
  set_normals(c);
  if (c->param->detection == PW_DETECT_CLOSED_GAP) {
    ask_extents(c);
    scatter_near(c, points, kernels->p2g_extent);
    set_gaps(c);
  }
}

pw_status pw_contact_surfaces_create(const pw_sim *sim, const pw_contact_frictional_param *param,
                                     pw_contact_surfaces *out)
{
  const pw_idx nblock = sim->blocks.nblock, nnode = sim->nodes.nnode;
  *out = (pw_contact_surfaces){.sim = sim, .param = param};
  PW_TRY(pw_mem_alloc("block supports", nblock, sizeof *out->support, &out->support));
  PW_TRY(pw_mem_alloc("blocks in contact", nblock, sizeof *out->near, &out->near));
  PW_TRY(pw_mem_alloc("surfaces", 2 * (pw_off)nnode * PW_NODE, sizeof(pw_real), &out->rec));
  PW_TRY(pw_mem_alloc("contact nodes", nnode, sizeof *out->list, &out->list));
  set_supports(sim, out->support);
  for (pw_off k = 0; k < 2 * (pw_off)nnode; k++) {
    out->rec[k * PW_NODE + PW_SURFACE_ASKS] = PW_HUGE;
  }
  return PW_OK;
}

void pw_contact_surfaces_destroy(pw_contact_surfaces *c)
{
  pw_mem_free(&c->support);
  pw_mem_free(&c->near);
  pw_mem_free(&c->rec);
  pw_mem_free(&c->list);
}
