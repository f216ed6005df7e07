/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interface lines that are dragged by a pile stretch behind it and crowd in front of it: segments
 * are split and merged, with mass, momentum and contact history. */
#include "engine/interface.h"

#include <math.h>
#include <string.h>

static pw_real distance(const pw_interface_node *a, const pw_interface_node *b)
{
  pw_real dx = b->x[0] - a->x[0], dy = b->x[1] - a->x[1];
  return sqrt(dx * dx + dy * dy);
}

/* Node before k, or -1 at the start of an open line. */
static pw_idx before(const pw_interface *line, pw_idx k)
{
  return k > 0 ? k - 1 : (line->closed ? line->n - 1 : -1);
}

static pw_idx after(const pw_interface *line, pw_idx k)
{
  return k + 1 < line->n ? k + 1 : (line->closed ? 0 : -1);
}

/* Mass that end `a` of a segment of length l gives to a node in its middle: half of what it holds
 * of this segment, `other` being the length of the segment on its other side. */
static pw_real share(const pw_interface *line, pw_idx a, pw_idx other, pw_real l)
{
  pw_real rest = other < 0 ? 0.0 : distance(&line->node[a], &line->node[other]);
  return 0.5 * line->node[a].mass * l / (l + rest);
}

static pw_touch middle_touch(const pw_touch *a, const pw_touch *b)
{
  pw_touch t = {.owner = -1, .fresh = true};
  if (a->owner >= 0 && b->owner >= 0) {
    t.owner = a->owner;
    t.overlap = 0.5 * (a->overlap + b->overlap);
    t.slip = 0.5 * (a->slip + b->slip);
  }
  return t;
}

static void split(pw_interface *line, pw_idx k, pw_real l)
{
  pw_idx next = pw_interface_next(line, k);
  pw_interface_node *a = &line->node[k], *b = &line->node[next];
  pw_real ma = share(line, k, before(line, k), l), mb = share(line, next, after(line, next), l);
  pw_interface_node c = {.mass = ma + mb, .tip = a->tip && b->tip};
  pw_real part = c.mass > 0.0 ? ma / c.mass : 0.5;
  for (int i = 0; i < 2; i++) {
    c.x[i] = 0.5 * (a->x[i] + b->x[i]);
    c.du[i] = 0.5 * (a->du[i] + b->du[i]);
    c.v[i] = part * a->v[i] + (1.0 - part) * b->v[i];
  }
  c.touch = middle_touch(&a->touch, &b->touch);
  a->mass -= ma;
  b->mass -= mb;
  memmove(&line->node[k + 2], &line->node[k + 1], (size_t)(line->n - k - 1) * sizeof line->node[0]);
  line->node[k + 1] = c;
  line->n++;
}

/* Distance of node k from the chord of its neighbours when it may be taken out, else -1. */
static pw_real removal_cost(const pw_interface *line, pw_idx k, pw_real longest)
{
  pw_idx p = before(line, k), q = after(line, k);
  if (p < 0 || q < 0 || line->n <= (line->closed ? 4 : 2)) {
    return -1.0;
  }
  const pw_real *a = line->node[p].x, *b = line->node[k].x, *c = line->node[q].x;
  pw_real chord = distance(&line->node[p], &line->node[q]);
  if (chord > longest) {
    return -1.0;
  }
  pw_real cross = (c[0] - a[0]) * (b[1] - a[1]) - (c[1] - a[1]) * (b[0] - a[0]);
  return chord > 0.0 ? fabs(cross) / chord : distance(&line->node[p], &line->node[k]);
}

static void give(const pw_interface_node *from, pw_real part, pw_interface_node *to)
{
  pw_real m = part * from->mass, sum = to->mass + m;
  for (int i = 0; i < 2 && sum > 0.0; i++) {
    to->v[i] = (to->mass * to->v[i] + m * from->v[i]) / sum;
  }
  to->mass = sum;
}

/* Energy of a node's springs. */
static pw_real spring_energy(const pw_touch *t)
{
  return 0.5 * (t->stiff_n * t->overlap * t->overlap + t->stiff_t * t->slip * t->slip);
}

static pw_real take_out(pw_interface *line, pw_idx k)
{
  pw_real released = line->node[k].touch.owner >= 0 ? spring_energy(&line->node[k].touch) : 0.0;
  pw_interface_node *p = &line->node[before(line, k)], *q = &line->node[after(line, k)];
  pw_real lp = distance(p, &line->node[k]), lq = distance(&line->node[k], q), l = lp + lq;
  pw_real part = l > 0.0 ? lq / l : 0.5;
  give(&line->node[k], part, p);
  give(&line->node[k], 1.0 - part, q);
  memmove(&line->node[k], &line->node[k + 1], (size_t)(line->n - k - 1) * sizeof line->node[0]);
  line->n--;
  return released;
}

/* Take out that end of the short segment k that changes the line less. */
static bool merge(pw_interface *line, pw_idx k, pw_real longest, pw_real *released)
{
  pw_idx next = pw_interface_next(line, k);
  pw_real ca = removal_cost(line, k, longest), cb = removal_cost(line, next, longest);
  if (ca < 0.0 && cb < 0.0) {
    return false;
  }
  *released += take_out(line, ca >= 0.0 && (cb < 0.0 || ca < cb) ? k : next);
  return true;
}

void pw_interface_refine(pw_interface *line, const pw_refine_rule *rule, pw_refine_counts *counts)
{
  const pw_real longest2 = rule->longest * rule->longest;
  const pw_real shortest2 = rule->shortest * rule->shortest;
  for (pw_idx k = 0; k < pw_interface_segments(line); k++) {
    const pw_real *a = line->node[k].x, *b = line->node[pw_interface_next(line, k)].x;
    pw_real dx = b[0] - a[0], dy = b[1] - a[1], l2 = dx * dx + dy * dy;
    if (l2 <= longest2 && l2 >= shortest2) {
      continue;
    }
    pw_real l = sqrt(l2);
    if (l > rule->longest && line->n < line->capacity) {
      split(line, k, l);
      counts->splits++;
      k++; /* both halves stay as they are until the next call */
    } else if (l > rule->longest) {
      counts->refused++;
    } else if (l < rule->shortest && merge(line, k, rule->longest, &counts->released)) {
      counts->merges++;
    }
  }
  pw_interface_measure(line);
}
