/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/tet_points.h"

#include <math.h>
#include <string.h>

#include "engine/core/mem.h"
#include "engine/umat.h"

enum { MOST = 20 };

static const char *const names[] = {"one", "four", "eleven_equal", "eleven_keast", "twenty"};

bool pw_tet_rule_find(const char *name, pw_tet_rule *rule)
{
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    if (strcmp(name, names[i]) == 0) {
      *rule = (pw_tet_rule)i;
      return true;
    }
  }
  return false;
}

/* Keast, Comput. Methods Appl. Mech. Engrg 55 (1986) 339-348: centroid, four points towards the
 * corners, six points at the edges. Weights are those of the unit tetrahedron times 6. */
static void keast(pw_real (*place)[4], pw_real *part)
{
  const pw_real a = (1.0 + sqrt(5.0 / 14.0)) / 4.0, b = 0.5 - a;
  int n = 5;
  for (int i = 0; i < 4; i++) {
    place[0][i] = 0.25;
    for (int j = 0; j < 4; j++) {
      place[1 + i][j] = i == j ? 11.0 / 14.0 : 1.0 / 14.0;
    }
    part[1 + i] = 6.0 * 343.0 / 45000.0;
  }
  part[0] = -6.0 * 74.0 / 5625.0;
  for (int i = 0; i < 4; i++) {
    for (int j = i + 1; j < 4; j++, n++) {
      for (int k = 0; k < 4; k++) {
        place[n][k] = k == i || k == j ? a : b;
      }
      part[n] = 6.0 * 56.0 / 2250.0;
    }
  }
}

/* An even lattice, four points along each edge. The squares of its coordinates (i + c)/(3 + 4 c) have
 * the mean 1/10 of the tetrahedron for 6 c^2 + 9 c = 9/2; no point lies on a face of an element when
 * the tetrahedron is divided into 8. */
static int lattice(pw_real (*place)[4], pw_real *part)
{
  const pw_real c = 0.25 * (sqrt(21.0) - 3.0);
  int n = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; i + j < 4; j++) {
      for (int k = 0; i + j + k < 4; k++, n++) {
        const int at[4] = {i, j, k, 3 - i - j - k};
        for (int l = 0; l < 4; l++) {
          place[n][l] = (at[l] + c) / (3.0 + 4.0 * c);
        }
        part[n] = 1.0 / 20.0;
      }
    }
  }
  return n;
}

int pw_tet_rule_points(pw_tet_rule rule, pw_real (*place)[4], pw_real *part)
{
  const pw_real b = (5.0 - sqrt(5.0)) / 20.0; /* Hammer, Stroud 1956 */
  switch (rule) {
  case PW_TET_RULE_ONE:
    part[0] = 1.0;
    for (int j = 0; j < 4; j++) {
      place[0][j] = 0.25;
    }
    return 1;
  case PW_TET_RULE_FOUR:
    for (int i = 0; i < 4; i++) {
      part[i] = 0.25;
      for (int j = 0; j < 4; j++) {
        place[i][j] = i == j ? 1.0 - 3.0 * b : b;
      }
    }
    return 4;
  case PW_TET_RULE_ELEVEN_EQUAL:
  case PW_TET_RULE_ELEVEN_KEAST:
    keast(place, part);
    for (int i = 0; rule == PW_TET_RULE_ELEVEN_EQUAL && i < 11; i++) {
      part[i] = 1.0 / 11.0;
    }
    return 11;
  case PW_TET_RULE_TWENTY:
    return lattice(place, part);
  }
  return 0;
}

void pw_tet_points_destroy(pw_tet_points *p)
{
  pw_mem_free(&p->x);
  pw_mem_free(&p->volume);
  pw_mem_free(&p->jac);
  pw_mem_free(&p->jac_bar);
  pw_mem_free(&p->def_grad);
  pw_mem_free(&p->def_grad_trial);
  pw_mem_free(&p->stress);
  pw_mem_free(&p->state);
  pw_mem_free(&p->stress_trial);
  pw_mem_free(&p->state_trial);
  pw_mem_free(&p->jac_bar_trial);
  pw_mem_free(&p->left_cg);
  pw_mem_free(&p->left_cg_trial);
  pw_mem_free(&p->mass);
  pw_mem_free(&p->velocity);
  pw_mem_free(&p->acceleration);
  pw_mem_free(&p->body);
  pw_mem_free(&p->elem);
  memset(p, 0, sizeof *p);
}

static pw_status allocate(pw_tet_points *p, bool left_cg, bool def_grad)
{
  const pw_off n = p->ld, states = n * p->nstate;
  if (def_grad) {
    PW_TRY(pw_mem_alloc("points: F", 9 * n, sizeof *p->def_grad, &p->def_grad));
    PW_TRY(pw_mem_alloc("points: trial F", 9 * n, sizeof *p->def_grad_trial, &p->def_grad_trial));
  }
  if (left_cg) {
    PW_TRY(pw_mem_alloc("points: b", 6 * n, sizeof *p->left_cg, &p->left_cg));
    PW_TRY(pw_mem_alloc("points: trial b", 6 * n, sizeof *p->left_cg_trial, &p->left_cg_trial));
  }
  PW_TRY(pw_mem_alloc("points: x", 3 * n, sizeof *p->x, &p->x));
  PW_TRY(pw_mem_alloc("points: volume", n, sizeof *p->volume, &p->volume));
  PW_TRY(pw_mem_alloc("points: J", n, sizeof *p->jac, &p->jac));
  PW_TRY(pw_mem_alloc("points: J of F-bar", n, sizeof *p->jac_bar, &p->jac_bar));
  PW_TRY(pw_mem_alloc("points: stress", 6 * n, sizeof *p->stress, &p->stress));
  PW_TRY(pw_mem_alloc("points: state", states, sizeof *p->state, &p->state));
  PW_TRY(pw_mem_alloc("points: trial stress", 6 * n, sizeof *p->stress_trial, &p->stress_trial));
  PW_TRY(pw_mem_alloc("points: trial state", states, sizeof *p->state_trial, &p->state_trial));
  PW_TRY(pw_mem_alloc("points: trial J", n, sizeof *p->jac_bar_trial, &p->jac_bar_trial));
  PW_TRY(pw_mem_alloc("points: mass", n, sizeof *p->mass, &p->mass));
  PW_TRY(pw_mem_alloc("points: body", n, sizeof *p->body, &p->body));
  return pw_mem_alloc("points: element", n, sizeof *p->elem, &p->elem);
}

pw_status pw_tet_points_let_move(pw_tet_points *p)
{
  const pw_off n = 3 * (pw_off)p->ld;
  if (p->velocity) {
    return PW_OK;
  }
  PW_TRY(pw_mem_alloc("points: velocity", n, sizeof *p->velocity, &p->velocity));
  return pw_mem_alloc("points: acceleration", n, sizeof *p->acceleration, &p->acceleration);
}

static pw_idx body_of(const pw_tet_fill *fill, pw_idx patch)
{
  return fill->body ? fill->body[patch] : 0;
}

static pw_status check_fill(const pw_tet_mesh *mesh, const pw_tet_fill *fill, const pw_real *part,
                            int n)
{
  PW_REQUIRE(n > 0, PW_ERR_ARGUMENT, "%d is no rule for points", (int)fill->rule);
  for (int i = 0; i < n; i++) {
    PW_REQUIRE(part[i] > 0.0 || fill->allow_negative, PW_ERR_ARGUMENT,
               "rule %s gives point %d the part %g of a volume: negative volumes have to be asked "
               "for",
               names[fill->rule], i, part[i]);
  }
  PW_REQUIRE(!fill->per_patch || mesh->per == 8, PW_ERR_ARGUMENT,
             "points per ten-node tetrahedron, but the mesh is of linear ones");
  for (pw_idx k = 0; k < mesh->npatch; k++) {
    PW_REQUIRE(body_of(fill, k) < fill->nmaterial, PW_ERR_ARGUMENT,
               "cell %d is of material %d of %d", (int)k, (int)body_of(fill, k),
               (int)fill->nmaterial);
  }
  for (pw_idx i = 0; i < fill->nmaterial; i++) {
    const pw_tet_material *m = &fill->material[i];
    PW_TRY(m->model->check(m->param));
    if (m->model->needs_library) {
      PW_TRY(pw_umat_load(m->param));
    }
  }
  return PW_OK;
}

/* Corners of a patch or element, and a point of it from volume coordinates. */
static void place_point(const pw_tets *t, const pw_idx *corner, const pw_real *place, pw_real *x)
{
  for (int c = 0; c < 3; c++) {
    x[c] = 0.0;
    for (int i = 0; i < 4; i++) {
      x[c] += place[i] * t->x[(size_t)c * (size_t)t->nnode + (size_t)corner[i]];
    }
  }
}

static void add_point(pw_tet_points *p, const pw_real *x, pw_real volume, pw_idx body, pw_idx elem)
{
  const size_t l = (size_t)p->ld, i = (size_t)p->n++;
  for (size_t c = 0; c < 3; c++) {
    p->x[c * l + i] = x[c];
  }
  p->volume[i] = volume;
  p->jac[i] = p->jac_bar[i] = 1.0;
  for (size_t c = 0; c < 3 && p->left_cg; c++) {
    p->left_cg[c * l + i] = 1.0;
  }
  for (size_t c = 0; c < 9 && p->def_grad; c += 4) {
    p->def_grad[c * l + i] = 1.0;
  }
  p->body[i] = body;
  p->elem[i] = elem;
}

/* The lowest element of a patch that holds x, or else the first. */
static pw_idx owner_in_patch(const pw_tet_mesh *mesh, pw_idx patch, const pw_real *x)
{
  for (pw_idx e = patch * mesh->per; e < (patch + 1) * mesh->per; e++) {
    if (pw_tets_hold(&mesh->tets, e, x)) {
      return e;
    }
  }
  return patch * mesh->per;
}

static void fill_patch(const pw_tet_mesh *mesh, const pw_tet_fill *fill, pw_idx patch,
                       pw_tet_points *p)
{
  pw_real place[MOST][4], part[MOST], x[3], volume = 0.0;
  const int n = pw_tet_rule_points(fill->rule, place, part);
  const pw_idx first = patch * mesh->per, last = first + mesh->per;
  for (pw_idx e = first; e < last; e++) {
    volume += mesh->tets.volume[e];
    for (int i = 0; i < n && !fill->per_patch; i++) {
      place_point(&mesh->tets, mesh->tets.node + 4 * e, place[i], x);
      add_point(p, x, part[i] * mesh->tets.volume[e], body_of(fill, patch), e);
    }
  }
  for (int i = 0; i < n && fill->per_patch; i++) { /* corners come first in a patch */
    place_point(&mesh->tets, mesh->patch_node + patch * mesh->patch_nodes, place[i], x);
    add_point(p, x, part[i] * volume, body_of(fill, patch), owner_in_patch(mesh, patch, x));
  }
}

/* Materials set their state in runs of points of one body. */
static void start_materials(const pw_tet_fill *fill, pw_tet_points *p)
{
  for (pw_idx first = 0, last; first < p->n; first = last) {
    const pw_tet_material *m = &fill->material[p->body[first]];
    last = first + 1;
    while (last < p->n && p->body[last] == p->body[first]) {
      last++;
    }
    for (pw_idx i = first; i < last; i++) {
      p->mass[i] = p->volume[i] * m->model->density(m->param);
    }
    if (m->model->place) {
      m->model->place(m->param, last - first, p->ld, p->x + p->ld + first, p->state + first);
    }
    m->model->init(m->param, last - first, p->ld, p->stress + first, p->state + first);
  }
}

pw_status pw_tet_points_create(const pw_tet_mesh *mesh, const pw_tet_fill *fill, pw_tet_points *out)
{
  pw_real place[MOST][4], part[MOST];
  const int n = pw_tet_rule_points(fill->rule, place, part);
  PW_TRY(check_fill(mesh, fill, part, n));
  pw_tet_points p = {.n = 0};
  pw_off total = 0;
  bool left_cg = false, def_grad = false;
  for (pw_idx k = 0; k < mesh->npatch; k++) {
    total += body_of(fill, k) >= 0 ? n * (fill->per_patch ? 1 : mesh->per) : 0;
  }
  PW_REQUIRE(total > 0 && total < 1 << 28, PW_ERR_ARGUMENT, "%lld points in a mesh",
             (long long)total);
  for (pw_idx i = 0; i < fill->nmaterial; i++) {
    int states = fill->material[i].model->nstate(fill->material[i].param);
    p.nstate = states > p.nstate ? states : p.nstate;
    left_cg = left_cg || fill->material[i].model->needs_left_cg;
    def_grad = def_grad || fill->material[i].model->needs_def_grad;
  }
  p.ld = pw_pad((pw_idx)total);
  pw_status s = allocate(&p, left_cg, def_grad);
  if (s != PW_OK) {
    pw_tet_points_destroy(&p);
    return s;
  }
  for (pw_idx k = 0; k < mesh->npatch; k++) {
    if (body_of(fill, k) >= 0) {
      fill_patch(mesh, fill, k, &p);
    }
  }
  start_materials(fill, &p);
  *out = p;
  return PW_OK;
}
