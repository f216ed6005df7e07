/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/interface.h"

#include <math.h>
#include <stdio.h>

#include "engine/core/mem.h"

/* Grid nodes with less than this part of the largest mass of their element are faded out. */
static const pw_real FADE = 0.02;

static pw_status allocate(pw_interface *line)
{
  const pw_off n = line->capacity;
  PW_TRY(pw_mem_alloc("interface nodes", n, sizeof *line->node, &line->node));
  PW_TRY(
      pw_mem_alloc("interface checkpoint", n * PW_INTERFACE_REALS, sizeof(pw_real), &line->packed));
  return pw_mem_alloc("interface checkpoint", n * 2, sizeof(pw_idx), &line->marks);
}

pw_status pw_interface_create(const pw_real *xy, const bool *tip, pw_idx n, bool closed, bool axi,
                              pw_idx capacity, pw_interface *out)
{
  PW_REQUIRE(n >= (closed ? 3 : 2) && capacity >= n, PW_ERR_ARGUMENT,
             "an interface line of %d nodes, room for %d", n, capacity);
  pw_interface line = {.body = -1, .closed = closed, .axi = axi, .n = n, .capacity = capacity};
  pw_status status = allocate(&line);
  if (status != PW_OK) {
    pw_interface_destroy(&line);
    return status;
  }
  for (pw_idx k = 0; k < n; k++) {
    pw_interface_node *a = &line.node[k];
    a->x[0] = xy[2 * k];
    a->x[1] = xy[2 * k + 1];
    a->tip = tip ? tip[k] : false;
    a->axis = axi && !closed && (k == 0 || k == n - 1) && fabs(a->x[0]) < 1e-9;
    a->x[0] = a->axis ? 0.0 : a->x[0];
    a->touch.owner = -1;
  }
  for (pw_idx k = 0; k < pw_interface_segments(&line); k++) {
    const pw_real *a = line.node[k].x, *b = line.node[pw_interface_next(&line, k)].x;
    if (!(hypot(b[0] - a[0], b[1] - a[1]) > 0.0)) {
      pw_interface_destroy(&line);
      PW_REQUIRE(false, PW_ERR_ARGUMENT, "segment %d of an interface line has no length", k);
    }
  }
  pw_interface_measure(&line);
  *out = line;
  return PW_OK;
}

void pw_interface_destroy(pw_interface *line)
{
  pw_mem_free(&line->node);
  pw_mem_free(&line->packed);
  pw_mem_free(&line->marks);
  *line = (pw_interface){0};
}

void pw_interface_measure(pw_interface *line)
{
  pw_interface_node *node = line->node;
  for (pw_idx k = 0; k < line->n; k++) {
    node[k].area = 0.0;
  }
  for (pw_idx k = 0; k < pw_interface_segments(line); k++) {
    pw_interface_node *a = &node[k], *b = &node[pw_interface_next(line, k)];
    pw_real dx = b->x[0] - a->x[0], dy = b->x[1] - a->x[1], l = sqrt(dx * dx + dy * dy);
    pw_real ra = line->axi ? (2.0 * a->x[0] + b->x[0]) * (1.0 / 3.0) : 1.0;
    pw_real rb = line->axi ? (a->x[0] + 2.0 * b->x[0]) * (1.0 / 3.0) : 1.0;
    a->area += 0.5 * l * ra;
    b->area += 0.5 * l * rb;
  }
}

void pw_interface_set_mass(pw_interface *line, pw_real surface_density)
{
  for (pw_idx k = 0; k < line->n; k++) {
    line->node[k].mass = surface_density * line->node[k].area;
  }
}

/* Cell along one axis and place in it, 0..1; outside the grid: its edge. */
static inline pw_idx cell_of(pw_real x, pw_real origin, pw_real inv, pw_idx cells, pw_real *place)
{
  pw_real g = pw_min(pw_max((x - origin) * inv, 0.0), (pw_real)cells);
  pw_idx k = (pw_idx)g;
  k = k < cells ? k : cells - 1;
  *place = g - (pw_real)k;
  return k;
}

static void locate_graded(pw_interface *line, const pw_mesh *mesh)
{
  for (pw_idx k = 0; k < line->n; k++) {
    pw_interface_node *n = &line->node[k];
    pw_idx node[4];
    pw_mesh_shape(mesh, n->x, node, n->shape);
    n->node = node[0];
  }
}

void pw_interface_locate(pw_interface *line, const pw_mesh *mesh)
{
  const pw_real inv = 1.0 / mesh->cell;
  line->row = mesh->nodes[0];
  if (mesh->graded) {
    locate_graded(line, mesh);
    return;
  }
  for (pw_idx k = 0; k < line->n; k++) {
    pw_interface_node *n = &line->node[k];
    pw_real a, b;
    pw_idx i = cell_of(n->x[0], mesh->origin[0], inv, mesh->cells[0], &a);
    pw_idx j = cell_of(n->x[1], mesh->origin[1], inv, mesh->cells[1], &b);
    n->node = j * mesh->nodes[0] + i;
    n->shape[0] = (1.0 - a) * (1.0 - b);
    n->shape[1] = a * (1.0 - b);
    n->shape[2] = (1.0 - a) * b;
    n->shape[3] = a * b;
  }
}

void pw_interface_use(const pw_interface *line, pw_nodes *nodes, int f)
{
  for (pw_idx k = 0; k < line->n; k++) {
    pw_nodes_use(nodes, f, line->node[k].node, 2);
    pw_nodes_use(nodes, f, line->node[k].node + line->row, 2);
  }
}

/* Record of grid node j (0..3) of the element whose lower left node is `first`. */
static inline pw_off record(const pw_interface *line, pw_idx first, int j)
{
  return (pw_off)(first + (j & 1) + (j >> 1) * line->row) * PW_NODE;
}

void pw_interface_p2g(const pw_interface *line, pw_real *rec)
{
  for (pw_idx k = 0; k < line->n; k++) {
    const pw_interface_node *a = &line->node[k];
    for (int j = 0; j < 4; j++) {
      pw_real *r = rec + record(line, a->node, j), m = a->shape[j] * a->mass;
      r[PW_NODE_MASS] += m;
      r[PW_NODE_VEL] += m * a->v[0];
      r[PW_NODE_VEL + 1] += m * a->v[1];
    }
  }
}

void pw_interface_remap(const pw_interface *line, pw_real *rec)
{
  for (pw_idx k = 0; k < line->n; k++) {
    const pw_interface_node *a = &line->node[k];
    for (int j = 0; j < 4; j++) {
      pw_real *r = rec + record(line, a->node, j), m = a->shape[j] * a->mass;
      r[PW_NODE_REMAP] += m * a->v[0];
      r[PW_NODE_REMAP + 1] += m * a->v[1];
    }
  }
}

static void set_weights(const pw_real *mass, pw_real cut_off, pw_interface_node *a)
{
  pw_real largest = pw_max(pw_max(mass[0], mass[1]), pw_max(mass[2], mass[3]));
  pw_real smallest = pw_min(pw_min(mass[0], mass[1]), pw_min(mass[2], mass[3]));
  if (smallest > cut_off && smallest >= FADE * largest) { /* inside the body */
    for (int j = 0; j < 4; j++) {
      a->weight[j] = a->shape[j];
    }
    return;
  }
  pw_real fade = 1.0 / pw_max(FADE * largest, cut_off), sum = 0.0, whole = 0.0;
  for (int j = 0; j < 4; j++) {
    pw_real active = mass[j] > cut_off ? 1.0 : 0.0;
    a->weight[j] = active * a->shape[j] * pw_min(1.0, mass[j] * fade);
    sum += a->weight[j];
    whole += active * mass[j];
  }
  /* All the mass at nodes whose shape function is (nearly) zero here: share it out by mass. */
  bool far = sum < 1e-6 && whole > 0.0;
  pw_real scale = far ? 1.0 / whole : (sum > 0.0 ? 1.0 / sum : 0.0);
  for (int j = 0; j < 4; j++) {
    a->weight[j] = scale * (far ? (mass[j] > cut_off ? mass[j] : 0.0) : a->weight[j]);
  }
}

void pw_interface_weights(pw_interface *line, const pw_real *rec, pw_real cut_off)
{
  for (pw_idx k = 0; k < line->n; k++) {
    pw_interface_node *a = &line->node[k];
    pw_real mass[4];
    for (int j = 0; j < 4; j++) {
      mass[j] = rec[record(line, a->node, j) + PW_NODE_MASS];
    }
    set_weights(mass, cut_off, a);
  }
}

/* sum w u over the grid nodes of a, with u in the slot that rec points to. */
static inline void gather(const pw_interface *line, const pw_real *rec, const pw_real *w,
                          const pw_interface_node *a, pw_real *u)
{
  u[0] = 0.0;
  u[1] = 0.0;
  for (int j = 0; j < 4; j++) {
    const pw_real *r = rec + record(line, a->node, j);
    u[0] += w[j] * r[0];
    u[1] += w[j] * r[1];
  }
}

void pw_interface_velocity(pw_interface *line, const pw_real *rec, bool increments)
{
  for (pw_idx k = 0; k < line->n; k++) {
    pw_interface_node *a = &line->node[k];
    pw_real dv[2], before[2] = {0.0, 0.0};
    gather(line, rec + (increments ? PW_NODE_FORCE : PW_NODE_VEL), a->shape, a, dv);
    if (!increments) {
      gather(line, rec + PW_NODE_FORCE, a->shape, a, before);
    }
    a->v[0] += dv[0] - before[0];
    a->v[1] += dv[1] - before[1];
  }
}

static inline void displace(pw_interface_node *a, const pw_real *v, pw_real dt)
{
  a->du[0] = a->axis ? 0.0 : dt * v[0];
  a->du[1] = dt * v[1];
  a->x[0] += a->du[0];
  a->x[1] += a->du[1];
}

static bool weightless(const pw_interface_node *a)
{
  return a->weight[0] + a->weight[1] + a->weight[2] + a->weight[3] <= 0.0;
}

/* The node with weights that is fewest nodes away along the line, the one before at equal count. */
static pw_idx nearest_carried(const pw_interface *line, pw_idx k)
{
  for (pw_idx far = 1; far < line->n; far++) {
    for (int way = -1; way <= 1; way += 2) {
      pw_idx m = k + way * far;
      m = line->closed ? (m + line->n) % line->n : m;
      if (m >= 0 && m < line->n && !weightless(&line->node[m])) {
        return m;
      }
    }
  }
  return -1;
}

void pw_interface_mass(const pw_interface *line, pw_real *rec)
{
  for (pw_idx k = 0; k < line->n; k++) {
    const pw_interface_node *a = &line->node[k];
    pw_real v[2];
    gather(line, rec + PW_NODE_FORCE, a->shape, a, v);
    for (int j = 0; j < 4; j++) {
      pw_real *r = rec + record(line, a->node, j), m = a->shape[j] * a->mass;
      r[PW_NODE_REMAP] += m * v[0];
      r[PW_NODE_REMAP + 1] += m * v[1];
    }
  }
}

void pw_interface_move(pw_interface *line, const pw_real *rec, int slot, pw_real dt)
{
  for (pw_idx k = 0; k < line->n; k++) {
    pw_idx from = weightless(&line->node[k]) ? nearest_carried(line, k) : k;
    pw_real v[2] = {0.0, 0.0};
    if (from >= 0) {
      gather(line, rec + slot, line->node[from].weight, &line->node[from], v);
    }
    displace(&line->node[k], v, dt);
  }
}

void pw_interface_set_velocity(pw_interface *line, const pw_real *v)
{
  for (pw_idx k = 0; k < line->n; k++) {
    line->node[k].v[0] = v[0];
    line->node[k].v[1] = v[1];
  }
}

void pw_interface_move_rigid(pw_interface *line, pw_real dt)
{
  for (pw_idx k = 0; k < line->n; k++) {
    displace(&line->node[k], line->node[k].v, dt);
  }
}

/* The reals of a node that go to a checkpoint, in order: x, du, v, mass, area, history. */
static void pack(pw_interface_node *a, pw_real *v, bool unpack)
{
  pw_touch *t = &a->touch;
  pw_real *part[PW_INTERFACE_REALS] = {&a->x[0], &a->x[1],    &a->du[0],  &a->du[1],   &a->v[0],
                                       &a->v[1], &a->mass,    &a->area,   &t->overlap, &t->offset,
                                       &t->slip, &t->stiff_n, &t->stiff_t};
  for (int i = 0; i < PW_INTERFACE_REALS; i++) {
    *(unpack ? part[i] : &v[i]) = *(unpack ? &v[i] : part[i]);
  }
}

static void pack_marks(pw_interface_node *a, pw_idx *mark, bool unpack)
{
  if (unpack) {
    a->touch.owner = mark[0];
    a->touch.fresh = mark[1] & 1;
    a->tip = mark[1] & 2;
    a->axis = mark[1] & 4;
  } else {
    mark[0] = a->touch.owner;
    mark[1] = (a->touch.fresh ? 1 : 0) + (a->tip ? 2 : 0) + (a->axis ? 4 : 0);
  }
}

pw_status pw_interface_archive(pw_interface *line, const char *name, pw_archive *ar)
{
  char path[2 * PW_NAME];
  for (pw_idx k = 0; k < line->capacity; k++) {
    pack(&line->node[k], line->packed + (pw_off)k * PW_INTERFACE_REALS, false);
    pack_marks(&line->node[k], line->marks + 2 * k, false);
  }
  snprintf(path, sizeof path, "%s/count", name);
  PW_TRY(ar->index(ar, path, &line->n, 1));
  PW_REQUIRE(line->n >= 2 && line->n <= line->capacity, PW_ERR_FILE,
             "%s holds %d interface nodes, the scene has room for 2 to %d", path, line->n,
             line->capacity);
  snprintf(path, sizeof path, "%s/nodes", name);
  PW_TRY(ar->real(ar, path, line->packed, (pw_off)line->capacity * PW_INTERFACE_REALS));
  snprintf(path, sizeof path, "%s/marks", name);
  PW_TRY(ar->index(ar, path, line->marks, 2 * (pw_off)line->capacity));
  for (pw_idx k = 0; ar->loading && k < line->capacity; k++) {
    pack(&line->node[k], line->packed + (pw_off)k * PW_INTERFACE_REALS, true);
    pack_marks(&line->node[k], line->marks + 2 * k, true);
  }
  return PW_OK;
}
