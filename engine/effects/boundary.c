/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Given velocity components (rollers, fixities, moving walls) at nodes of the grid.
 *
 * Points receive no increment at a held node, so what the boundary gives to the points in a step
 * is minus the momentum m (v(n+1) - v(n)) that the forces would have given to the node: this is the
 * reaction. A component held by two instances is counted by the first of them.
 */
#include "engine/effects/common.h"
#include "engine/effects/params.h"

#include <math.h>
#include <stdio.h>

#include "engine/core/mem.h"
#include "engine/full_mass.h"
#include "engine/step_implicit.h"

#define AT(member) offsetof(pw_boundary_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"side", PW_KEY_CHOICE, AT(side), 0, 0, "box", "bottom|top|left|right|box", NULL,
   "side of the grid, or the nodes in the box x_m, y_m"},
  {"x_m", PW_KEY_PAIR, AT(x_m), -1e6, 1e6, NULL, NULL, "side=box",
   "left and right edge of the box, edges included"},
  {"y_m", PW_KEY_PAIR, AT(y_m), -1e6, 1e6, NULL, NULL, "side=box",
   "lower and upper edge of the box"},
  {"fix_x", PW_KEY_BOOL, AT(fix_x), 0, 0, "false", NULL, NULL,
   "hold the horizontal velocity at velocity_x_m_s"},
  {"fix_y", PW_KEY_BOOL, AT(fix_y), 0, 0, "false", NULL, NULL,
   "hold the vertical velocity at velocity_y_m_s"},
  {"velocity_x_m_s", PW_KEY_REAL, AT(velocity_x_m_s), -1e6, 1e6, "0", NULL, NULL,
   "horizontal velocity of the boundary"},
  {"velocity_y_m_s", PW_KEY_REAL, AT(velocity_y_m_s), -1e6, 1e6, "0", NULL, NULL,
   "vertical velocity of the boundary"},
  {"body", PW_KEY_BODY, AT(body), 0, 0, "", NULL, NULL,
   "hold only this body's velocity field; absent: every body"},
  {0}};
/* clang-format on */

typedef struct boundary {
  const pw_boundary_param *param;
  int instance;
  bool fix[2];
  pw_real velocity[2];
  pw_real reaction[2]; /* on the bodies, mean over the last step, whole body; N */
  pw_idx n;
  pw_idx *node;    /* [n] ascending */
  pw_real *gained; /* [nfield][n][2] momentum that each node in use is kept from gaining; kg m/s */
} boundary;

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_boundary_param *p = param;
  PW_REQUIRE(p->fix_x || p->fix_y, PW_ERR_SCENE, "neither fix_x nor fix_y is true");
  PW_REQUIRE(p->fix_x || p->velocity_x_m_s == 0.0, PW_ERR_SCENE,
             "velocity_x_m_s needs fix_x: true");
  PW_REQUIRE(p->fix_y || p->velocity_y_m_s == 0.0, PW_ERR_SCENE,
             "velocity_y_m_s needs fix_y: true");
  PW_REQUIRE(p->side != PW_SIDE_BOX || (p->x_m[0] <= p->x_m[1] && p->y_m[0] <= p->y_m[1]),
             PW_ERR_SCENE, "x_m and y_m must be written [smaller, larger]");
  PW_REQUIRE(p->body < 0 || scene->nbody == 1 || pw_scene_contacts(scene) > 0, PW_ERR_SCENE,
             "body: without a contact all bodies share one velocity field");
  return PW_OK;
}

/* Whether the boundary holds node (i, j). */
static bool holds(const boundary *c, const pw_mesh *m, pw_idx i, pw_idx j)
{
  const pw_boundary_param *p = c->param;
  pw_real tol = 1e-6 * m->cell;
  pw_idx node = j * m->nodes[0] + i;
  pw_real x = pw_mesh_node_x(m, node), y = pw_mesh_node_y(m, node);
  switch ((pw_side)p->side) {
  case PW_SIDE_BOTTOM:
    return j == 0;
  case PW_SIDE_TOP:
    return j == m->nodes[1] - 1;
  case PW_SIDE_LEFT:
    return i == 0;
  case PW_SIDE_RIGHT:
    return i == m->nodes[0] - 1;
  case PW_SIDE_BOX:
    break;
  }
  return x >= p->x_m[0] - tol && x <= p->x_m[1] + tol && y >= p->y_m[0] - tol &&
         y <= p->y_m[1] + tol;
}

static void collect(boundary *c, const pw_mesh *m)
{
  c->n = 0;
  for (pw_idx j = 0; j < m->nodes[1]; j++) {
    for (pw_idx i = 0; i < m->nodes[0]; i++) {
      if (!holds(c, m, i, j)) {
        continue;
      }
      if (c->node) {
        c->node[c->n] = j * m->nodes[0] + i;
      }
      c->n++;
    }
  }
}

/* A node that hangs is held with those it hangs on, or not at all. */
static pw_status check_hanging(const boundary *c, const pw_mesh *m)
{
  for (pw_idx k = 0; k < c->n; k++) {
    const pw_idx i = c->node[k] % m->nodes[0], j = c->node[k] / m->nodes[0];
    PW_REQUIRE(!pw_mesh_hangs(m, i, j) || (holds(c, m, i, j - 1) && holds(c, m, i, j + 1)),
               PW_ERR_SCENE,
               "boundary %d holds the node at (%g, %g) m, which hangs on those below and above "
               "(grid: paired_rows_x_m), but not both of these",
               c->instance, pw_mesh_node_x(m, c->node[k]), pw_mesh_node_y(m, c->node[k]));
  }
  return PW_OK;
}

/* The nodes held among a part of the records. */
static void hold(const pw_sim *sim, void *ctx, int part, int parts)
{
  const boundary *c = ctx;
  int first, last;
  pw_idx from, to;
  pw_effect_fields(sim, c->param->body, &first, &last);
  pw_nodes_part(&sim->nodes, part, parts, &from, &to);
  for (int f = first; f < last; f++) {
    pw_real *rec = pw_nodes_field(&sim->nodes, f), *gained = c->gained + 2 * (pw_off)f * c->n;
    for (pw_idx k = 0; k < c->n; k++) {
      pw_real *r = rec + (pw_off)c->node[k] * PW_NODE;
      if (!pw_nodes_in_part(&sim->nodes, f, c->node[k], from, to)) {
        continue;
      }
      for (int a = 0; a < 2; a++) {
        if (c->fix[a]) {
          gained[2 * k + a] = r[PW_NODE_MASS] * (r[PW_NODE_VEL + a] - r[PW_NODE_FORCE + a]);
          r[PW_NODE_VEL + a] = r[PW_NODE_FORCE + a] = c->velocity[a];
        }
      }
    }
  }
}

/* Remapped velocities give the points no momentum; the second term of the mass matrix does. It is
 * held at v(n), where whoever held the component last has put that of the first term, too. */
static void hold_remapped(const pw_sim *sim, void *ctx, int part, int parts)
{
  const boundary *c = ctx;
  const bool adds = pw_full_mass_adding(sim);
  int first, last;
  pw_idx from, to;
  pw_effect_fields(sim, c->param->body, &first, &last);
  pw_nodes_part(&sim->nodes, part, parts, &from, &to);
  for (int f = first; f < last; f++) {
    pw_real *rec = pw_nodes_field(&sim->nodes, f), *gained = c->gained + 2 * (pw_off)f * c->n;
    for (pw_idx k = 0; k < c->n; k++) {
      pw_real *r = rec + (pw_off)c->node[k] * PW_NODE, *v = r + sim->node_slot;
      for (int a = 0; a < 2 && pw_nodes_in_part(&sim->nodes, f, c->node[k], from, to); a++) {
        const pw_real own = adds ? r[PW_NODE_FORCE + a] : c->velocity[a];
        const pw_real held = c->fix[a] ? own : v[a];
        gained[2 * k + a] += adds ? r[PW_NODE_MASS] * (v[a] - held) : 0.0;
        v[a] = held;
      }
    }
  }
}

/* Summed in the order of fields and nodes, whoever held them. */
static pw_status sum_reaction(pw_sim *sim, void *ctx)
{
  boundary *c = ctx;
  int first, last;
  pw_real sum[2] = {0.0, 0.0};
  pw_effect_fields(sim, c->param->body, &first, &last);
  for (int f = first; f < last; f++) {
    for (pw_idx k = 0; k < c->n; k++) {
      pw_real *gained = c->gained + 2 * ((pw_off)f * c->n + k);
      const bool held = pw_nodes_in_use(&sim->nodes, f, c->node[k]);
      for (int a = 0; a < 2; a++) {
        sum[a] += held ? gained[a] : 0.0; /* else of a step that failed */
        gained[a] = 0.0;                  /* the record may be out of use in the next step */
      }
    }
  }
  for (int a = 0; a < 2; a++) {
    c->reaction[a] = -sim->measure * sum[a] / sim->dt;
    sim->energy.external += c->reaction[a] * c->velocity[a] * sim->dt;
  }
  return PW_OK;
}

/* Implicit steps: what the nodes move over the part. */
static pw_status hold_displacement(pw_sim *sim, void *ctx)
{
  const boundary *c = ctx;
  for (pw_idx k = 0; k < c->n; k++) {
    for (int a = 0; a < 2; a++) {
      if (c->fix[a]) {
        pw_quad_model_hold(&sim->quad->model, c->node[k], a, c->instance + 1,
                           c->velocity[a] * sim->dt);
      }
    }
  }
  return PW_OK;
}

static pw_status react(pw_sim *sim, void *ctx)
{
  boundary *c = ctx;
  for (int a = 0; a < 2; a++) {
    pw_real sum = 0.0;
    for (pw_idx k = 0; k < c->n; k++) {
      sum += pw_quad_model_reaction(&sim->quad->model, c->node[k], a, c->instance + 1);
    }
    c->reaction[a] = sim->measure * sum;
    sim->energy.external += c->reaction[a] * c->velocity[a] * sim->dt;
  }
  return PW_OK;
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  const boundary *c = ctx;
  char name[64];
  (void)sim;
  for (int a = 0; a < 2; a++) {
    snprintf(name, sizeof name, "boundary_%d_force_%c_n", c->instance, a == 0 ? 'x' : 'y');
    pw_record_put(row, name, c->reaction[a]);
  }
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  boundary *c = ctx;
  char name[64];
  (void)sim;
  snprintf(name, sizeof name, "boundary_%d/reaction", c->instance);
  return ar->real(ar, name, c->reaction, 2);
}

static void destroy(void **ctx)
{
  boundary *c = *ctx;
  if (c) {
    pw_mem_free(&c->node);
    pw_mem_free(&c->gained);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  boundary *c;
  PW_TRY(pw_mem_alloc("boundary", 1, sizeof *c, &c));
  *ctx = c;
  const pw_boundary_param *p = param;
  c->param = p;
  c->instance = pw_effect_instance(sim, param);
  c->fix[0] = p->fix_x;
  c->fix[1] = p->fix_y;
  c->velocity[0] = p->fix_x ? p->velocity_x_m_s : 0.0;
  c->velocity[1] = p->fix_y ? p->velocity_y_m_s : 0.0;
  collect(c, &sim->mesh);
  PW_REQUIRE(c->n > 0, PW_ERR_SCENE, "boundary %d holds no node of the grid", c->instance);
  PW_TRY(pw_mem_alloc("boundary nodes", c->n, sizeof(pw_idx), &c->node));
  collect(c, &sim->mesh);
  PW_TRY(pw_mem_alloc("boundary: momenta", 2 * (pw_off)sim->nodes.nfield * c->n, sizeof(pw_real),
                      &c->gained));
  return check_hanging(c, &sim->mesh);
}

static const pw_part_hook part_hooks[] = {
    {PW_STAGE_CONSTRAINT, hold},
    {PW_STAGE_REMAP, hold_remapped},
    {0, NULL},
};

static const pw_hook hooks[] = {
    {PW_STAGE_END, sum_reaction},
    {0, NULL},
};

static const pw_hook implicit_hooks[] = {
    {PW_STAGE_CONSTRAINT, hold_displacement},
    {PW_STAGE_END, react},
    {0, NULL},
};

const pw_effect pw_effect_boundary = {
    .name = "boundary",
    .brief = "given velocity components at nodes: rollers, fixities, moving walls",
    .many = true,
    .keys = keys,
    .hooks = hooks,
    .part_hooks = part_hooks,
    .implicit = implicit_hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .archive = archive,
};
