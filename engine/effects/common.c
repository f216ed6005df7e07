/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/common.h"

#include <omp.h>

#include "engine/effects/load_curve.h"

enum { CHUNK = 512 };

pw_off pw_sum_scratch(pw_off n)
{
  return (n + CHUNK - 1) / CHUNK * PW_SUMS;
}

static void add_parts(const pw_real *part, pw_off chunks, pw_real *out)
{
  for (int s = 0; s < PW_SUMS; s++) {
    out[s] = 0.0;
    for (pw_off k = 0; k < chunks; k++) {
      out[s] += part[k * PW_SUMS + s];
    }
  }
}

void pw_sum_items(pw_sum_fn fn, const void *ctx, pw_off n, int threads, pw_real *part, pw_real *out)
{
  const pw_off chunks = (n + CHUNK - 1) / CHUNK;
#pragma omp parallel for default(none) shared(fn, ctx, n, part, chunks) num_threads(threads)       \
    schedule(static)
  for (pw_off k = 0; k < chunks; k++) {
    pw_real sum[PW_SUMS] = {0.0};
    fn(ctx, k * CHUNK, (k + 1) * CHUNK < n ? (k + 1) * CHUNK : n, sum);
    for (int s = 0; s < PW_SUMS; s++) {
      part[k * PW_SUMS + s] = sum[s];
    }
  }
  add_parts(part, chunks, out);
}

/* Calls fn for each run of groups in use among records [first, last). */
static void sum_runs(pw_sum_fn fn, const void *ctx, const pw_nodes *nodes, const pw_off *range,
                     pw_real *sum)
{
  for (pw_off k = range[0]; k < range[1];) {
    const bool want = nodes->in_use[k / PW_NODE_GROUP];
    const pw_off first = k;
    while (k < range[1] && nodes->in_use[k / PW_NODE_GROUP] == want) {
      k = (k / PW_NODE_GROUP + 1) * PW_NODE_GROUP;
    }
    k = k < range[1] ? k : range[1];
    if (want) {
      fn(ctx, first, k, sum);
    }
  }
}

static pw_off chunks_of(const pw_sim *sim, const int field[2])
{
  return ((pw_off)(field[1] - field[0]) * sim->nodes.nnode + CHUNK - 1) / CHUNK;
}

/* Whether a chunk of records belongs to part `thread`, which has just made the velocities of the
 * first group in use in it; one without any belongs to part 0. */
static bool owns(const pw_nodes *nodes, pw_off from, pw_off to, int thread, int threads)
{
  pw_idx first, last;
  pw_nodes_part(nodes, thread, threads, &first, &last);
  for (pw_off g = from / PW_NODE_GROUP; g * PW_NODE_GROUP < to; g++) {
    if (nodes->in_use[g]) {
      return nodes->place[g] >= first && nodes->place[g] < last;
    }
  }
  return thread == 0;
}

void pw_sum_nodes_part(pw_sum_fn fn, const void *ctx, const pw_sim *sim, const int field[2],
                       pw_real *part, int thread, int threads)
{
  const pw_nodes *nodes = &sim->nodes;
  const pw_off first = (pw_off)field[0] * nodes->nnode, last = (pw_off)field[1] * nodes->nnode;
  const pw_off chunks = chunks_of(sim, field);
  for (pw_off k = 0; k < chunks; k++) {
    const pw_off from = first + k * CHUNK, to = from + CHUNK < last ? from + CHUNK : last;
    pw_real sum[PW_SUMS] = {0.0};
    if (!owns(nodes, from, to, thread, threads)) {
      continue;
    }
    sum_runs(fn, ctx, nodes, (const pw_off[]){from, to}, sum);
    for (int s = 0; s < PW_SUMS; s++) {
      part[k * PW_SUMS + s] = sum[s];
    }
  }
}

void pw_sum_nodes_end(const pw_sim *sim, const int field[2], const pw_real *part, pw_real *out)
{
  add_parts(part, chunks_of(sim, field), out);
}

void pw_sum_nodes(pw_sum_fn fn, const void *ctx, const pw_sim *sim, const int field[2],
                  pw_real *part, pw_real *out)
{
#pragma omp parallel default(none) shared(fn, ctx, sim, field, part) num_threads(sim->threads)
  pw_sum_nodes_part(fn, ctx, sim, field, part, omp_get_thread_num(), omp_get_num_threads());
  pw_sum_nodes_end(sim, field, part, out);
}

int pw_effect_instance(const pw_sim *sim, const void *param)
{
  const pw_scene *scene = &sim->scene;
  for (int e = 0; e < scene->neffect; e++) {
    if ((const void *)scene->effect[e].param != param) {
      continue;
    }
    int rank = 0;
    for (int k = 0; k < e; k++) {
      rank += scene->effect[k].type == scene->effect[e].type;
    }
    return rank;
  }
  return 0;
}

void pw_effect_fields(const pw_sim *sim, int b, int *first, int *last)
{
  *first = b < 0 ? 0 : sim->body[b].field;
  *last = b < 0 ? sim->nodes.nfield : *first + 1;
}

int pw_scene_contacts(const pw_scene *scene)
{
  int count = 0;
  for (int e = 0; e < scene->neffect; e++) {
    count += scene->effect[e].type && scene->effect[e].type->own_velocity_fields;
  }
  return count;
}

pw_real pw_effect_ramp(const pw_sim *sim, pw_real start, pw_real length)
{
  return sim->quad ? pw_ramp(sim->time + sim->dt, start, length)
                   : pw_ramp_mean(sim->time, sim->dt, start, length);
}
