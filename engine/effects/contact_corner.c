/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Corner contact: the corners of the slave's CPDI domains, and the middles of their edges, stay
 * outside the surface of the master.
 *
 * No interface line of the slave, so nothing to drag, split or tangle: every domain near the
 * surface is covered. The middles keep edges that have been stretched along a curved surface from
 * cutting through it. A penalty normal force per site with its share of the surface, and Coulomb's
 * friction with adhesion on the way of the site along the master's material. The
 * master is a body of points, whose line moves in its velocity field and has no mass of its own,
 * or a structure (engine/structure.h).
 *
 * Energies: `spring` is what the springs hold. A spring whose stiffness follows the soil's wave
 * speed changes its energy at constant stretch; that is no work of a load but a loss or gain of
 * the contact itself, so it is booked with friction under `contact`.
 */
#include "engine/effects/contact_corner.h"

#include "engine/core/mem.h"
#include "engine/rates.h"

#define AT(member) offsetof(pw_contact_corner_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"master", PW_KEY_BODY, AT(master), 0, 0, NULL, NULL, NULL,
   "body whose surface pushes: pile, plane"},
  {"slave", PW_KEY_BODY, AT(slave), 0, 0, NULL, NULL, NULL,
   "body of points whose domains' corners stay outside the master: soil"},
  {"friction", PW_KEY_REAL, AT(friction), 0, 1e6, NULL, NULL, NULL,
   "Coulomb's coefficient"},
  {"adhesion_pa", PW_KEY_REAL, AT(adhesion_pa), 0, 1e15, "0", NULL, NULL,
   "shear strength of the interface besides friction, while in contact"},
  {"adhesion_gap_m", PW_KEY_REAL, AT(adhesion_gap_m), 0, 1e6, "0", NULL, NULL,
   "adhesion acts on what is nearer to the surface, half a domain, say; 0: only on what presses"},
  {"shear_limit_pa", PW_KEY_REAL, AT(shear_limit_pa), 0, 1e15, "0", NULL, NULL,
   "largest shear stress of the interface; 0: no limit"},
  {"stiffness_factor", PW_KEY_REAL, AT(stiffness_factor), PW_TINY, 1e6, "0.2", NULL, NULL,
   "stiffness as a part of density times squared wave speed over half a domain; soil softer than a "
   "fiftieth of the stiffest in contact counts as that"},
  {"normal_stiffness_pa_m", PW_KEY_REAL, AT(normal_stiffness_pa_m), 0, 1e20, "0", NULL, NULL,
   "contact pressure per metre of overlap; 0: by stiffness_factor from the present wave speed"},
  {"step_frequency_max", PW_KEY_REAL, AT(step_frequency_max), 0.05, 1.8, "0.8", NULL, NULL,
   "largest step times the bound of the springs' frequency; above 1.3 stability is not proven: look "
   "at the energy balance"},
  {"segment_m", PW_KEY_REAL, AT(segment_m), 0, 1e6, "0", NULL, NULL,
   "largest length of the master's surface segments, at most a cell; 0: a quarter of a cell"},
  {"rounding_m", PW_KEY_REAL, AT(rounding_m), 0, 1e6, "0", NULL, NULL,
   "radius of the master's convex edges, less where segments are short; 0: half a segment"},
  {0}};
/* clang-format on */

static pw_real segment_length(const pw_scene *scene, const pw_contact_corner_param *p)
{
  return p->segment_m > 0.0 ? p->segment_m : 0.25 * scene->grid.cell_m;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_contact_corner_param *p = param;
  PW_TRY(pw_contact_check(scene, p->master, p->slave));
  PW_REQUIRE(scene->method.basis == PW_CPDI, PW_ERR_SCENE,
             "the corners of domains are in contact: method.basis must be cpdi");
  PW_REQUIRE(scene->body[p->slave].kind == PW_BODY_POINTS, PW_ERR_SCENE,
             "the slave '%s' must be a body of points", scene->body[p->slave].name);
  PW_REQUIRE(p->adhesion_gap_m <= 0.5 * scene->grid.cell_m, PW_ERR_SCENE,
             "adhesion_gap_m = %g m must be at most half a cell, %g m", p->adhesion_gap_m,
             0.5 * scene->grid.cell_m);
  PW_REQUIRE(p->segment_m <= scene->grid.cell_m * (1.0 + 1e-9), PW_ERR_SCENE,
             "segment_m = %g m must not be longer than a cell, %g m", p->segment_m,
             scene->grid.cell_m);
  return PW_OK;
}

/* Density times squared wave speed, mean of the master's points; Pa. */
static pw_real modulus_of(const pw_sim *sim, int body)
{
  const pw_points *p = &sim->points;
  pw_real sum = 0.0, count = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    if (p->body[i] == body) {
      sum += p->mass[i] / p->vol[i] * p->wave_speed[i] * p->wave_speed[i];
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

/* The records and the surface of the present step. */
static void bind_step(pw_sim *sim, pw_corner *c)
{
  const int master = c->param->master;
  c->given = sim->body[master].prescribed;
  c->slave_rec = pw_nodes_field(&sim->nodes, sim->body[c->param->slave].field);
  if (!c->structure) {
    c->master_rec = pw_nodes_field(&sim->nodes, sim->body[master].field);
    pw_interface_locate(&c->own, &sim->mesh);
    pw_interface_weights(&c->own, c->master_rec, sim->mass_cut_off);
    if (c->master_modulus <= 0.0 && !c->given) {
      c->master_modulus = modulus_of(sim, master);
    }
  }
  pw_round_line_update(&c->surface, &sim->mesh);
}

/* Step for the next forces. What has been let go may be back at once, driven by the stress that the
 * contact held: the step then grows by and by to that of the bodies, and finds it in time. */
static pw_real next_step(const pw_sim *sim, pw_corner *c)
{
  static const pw_real growth = 1.5;
  pw_real limit = pw_corner_limit(c), last = sim->dt_contact;
  return c->npair == 0 && last > 0.0 && last < sim->dt_next ? growth * last : limit;
}

/* Note when blocks have been looked at: the next look counts the way since then. */
static void finish_step(const pw_sim *sim, pw_corner *c)
{
  c->last_dt = sim->dt;
  for (pw_idx k = 0; sim->rates && k < sim->blocks.nblock; k++) {
    c->begun[k] = pw_rates_starts(sim, k) ? sim->time : c->begun[k];
  }
}

static pw_status add_forces(pw_sim *sim, void *ctx)
{
  pw_corner *c = ctx;
  pw_real spring, dissipated;
  bind_step(sim, c);
  pw_contact_tally_begin(&c->tally);
  PW_TRY(pw_corner_search(c));
  sim->dt_contact = next_step(sim, c);
  pw_corner_forces(c, &spring, &dissipated);
  finish_step(sim, c);
  pw_contact_tally_end(&c->tally, sim->measure, sim->dt);
  sim->energy.spring += sim->measure * spring;
  sim->energy.contact += sim->measure * dissipated;
  return PW_OK;
}

static pw_status move_line(pw_sim *sim, void *ctx)
{
  pw_corner *c = ctx;
  if (c->structure) {
    return PW_OK;
  }
  if (c->given) {
    pw_interface_set_velocity(&c->own, sim->body[c->param->master].prescribed_v);
    pw_interface_move_rigid(&c->own, sim->dt);
  } else {
    pw_interface_move(&c->own, c->master_rec, sim->node_slot, sim->dt);
  }
  return PW_OK;
}

/* Node ranges of the blocks' elements. */
static void set_boxes(const pw_sim *sim, pw_idx *box)
{
  const pw_blocks *b = &sim->blocks;
  const pw_mesh *m = &sim->mesh;
  for (pw_idx k = 0; k < b->nblock; k++) {
    pw_idx *to = box + 4 * (pw_off)k;
    pw_idx low[2] = {m->cells[0], m->cells[1]}, high[2] = {0, 0};
    for (pw_idx e = b->elem_start[k]; e < b->elem_start[k + 1]; e++) {
      const pw_idx at[2] = {b->elem[e] % m->cells[0], b->elem[e] / m->cells[0]};
      for (int a = 0; a < 2; a++) {
        low[a] = at[a] < low[a] ? at[a] : low[a];
        high[a] = at[a] > high[a] ? at[a] : high[a];
      }
    }
    for (int a = 0; a < 2; a++) {
      to[2 * a] = low[a];
      to[2 * a + 1] = high[a] + 1;
    }
  }
}

static pw_status allocate(const pw_sim *sim, pw_corner *c)
{
  const pw_off n = sim->points.n, sites = PW_SITES * n;
  /* All sites of a small body may be in contact, of a large one hardly one in eight. */
  c->capacity = (pw_idx)(sites < n + 4096 ? sites : n + 4096);
  PW_TRY(pw_mem_alloc("contact pairs", c->capacity, sizeof *c->pair, &c->pair));
  if (sim->rates) {
    PW_TRY(pw_mem_alloc("contact pairs", c->capacity, sizeof *c->last, &c->last));
    PW_TRY(pw_mem_alloc("contact steps", sim->blocks.nblock, sizeof(pw_real), &c->begun));
  }
  PW_TRY(pw_mem_alloc("contact sites", sites, sizeof(pw_idx), &c->found));
  PW_TRY(pw_mem_alloc("contact sites", sites, sizeof(pw_idx), &c->segment));
  PW_TRY(pw_mem_alloc("contact sums", sim->blocks.nblock, sizeof *c->sums, &c->sums));
  PW_TRY(pw_mem_alloc("contact blocks", sim->blocks.nblock, sizeof(pw_idx), &c->near));
  PW_TRY(pw_mem_alloc("contact boxes", 4 * (pw_off)sim->blocks.nblock, sizeof(pw_idx), &c->box));
  PW_TRY(pw_mem_alloc("contact cover", c->surface.line->n, sizeof(pw_real), &c->covered));
  return pw_mem_alloc("contact stiffness", sim->mesh.nnode, sizeof(pw_real), &c->stiffness);
}

static pw_status build(pw_sim *sim, const pw_contact_corner_param *p, pw_corner *c)
{
  const pw_real segment = segment_length(&sim->scene, p);
  c->param = p;
  c->sim = sim;
  c->softest = PW_HUGE;
  c->structure = sim->structure_of[p->master];
  if (!c->structure) { /* the line has no mass: all of the master's is that of its points */
    PW_TRY(pw_interface_from_body(&sim->scene, p->master, -1, segment, 0.0, &c->own));
  }
  PW_TRY(pw_round_line_create(c->structure ? &c->structure->line : &c->own,
                              p->rounding_m > 0.0 ? p->rounding_m : 0.5 * segment, &sim->mesh,
                              &c->surface));
  PW_TRY(allocate(sim, c));
  set_boxes(sim, c->box);
  for (pw_off k = 0; k < PW_SITES * (pw_off)sim->points.ld; k++) {
    sim->points.contact_arc[k] = -1.0;
  }
  return PW_OK;
}

static void destroy(void **ctx)
{
  pw_corner *c = *ctx;
  if (c) {
    pw_interface_destroy(&c->own);
    pw_round_line_destroy(&c->surface);
    pw_mem_free(&c->pair);
    pw_mem_free(&c->last);
    pw_mem_free(&c->begun);
    pw_mem_free(&c->found);
    pw_mem_free(&c->segment);
    pw_mem_free(&c->sums);
    pw_mem_free(&c->near);
    pw_mem_free(&c->box);
    pw_mem_free(&c->covered);
    pw_mem_free(&c->stiffness);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  pw_corner *c;
  PW_TRY(pw_mem_alloc("contact_corner", 1, sizeof *c, &c));
  *ctx = c;
  return build(sim, param, c);
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  (void)sim;
  pw_corner *c = ctx;
  pw_contact_tally_history(&c->tally, row);
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  (void)sim;
  const pw_corner *c = ctx;
  const bool touched = c->softest < PW_HUGE;
  pw_record_put(out, "contact_overlap_max_m", c->tally.overlap_max);
  pw_record_put(out, "contact_point_depth_max_m", c->centre_max);
  pw_record_put(out, "contact_stiffness_min_pa_m", touched ? c->softest : 0.0);
  pw_record_put(out, "contact_stiffness_max_pa_m", c->stiffest);
  pw_record_put(out, "contact_rounding_m", c->surface.rounding);
  pw_record_put(out, "contact_stiffness_reduced", (pw_real)c->reduced);
  pw_record_put(out, "contact_offset_max_m", c->offset_max);
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  pw_corner *c = ctx;
  pw_real value[7] = {c->master_modulus, c->centre_max, c->softest,      c->stiffest,
                      c->offset_max,     c->last_dt,    c->slave_modulus};
  PW_TRY(pw_contact_tally_archive(&c->tally, "contact_corner/reaction", ar));
  if (!c->structure) {
    PW_TRY(pw_interface_archive(&c->own, "contact_corner/master", ar));
  }
  PW_TRY(ar->real(ar, "contact_corner/numbers", value, 7));
  PW_TRY(ar->offset(ar, "contact_corner/reduced", &c->reduced, 1));
  if (sim->rates) {
    PW_TRY(ar->real(ar, "contact_corner/begun", c->begun, sim->blocks.nblock));
  }
  c->master_modulus = value[0];
  c->centre_max = value[1];
  c->softest = value[2];
  c->stiffest = value[3];
  c->offset_max = value[4];
  c->last_dt = value[5];
  c->slave_modulus = value[6];
  return PW_OK;
}

int pw_corner_outline(const pw_sim *sim, int which, pw_real *xy, int max)
{
  const pw_corner *c = pw_sim_effect_ctx(sim, "contact_corner");
  if (!c || which != 0) {
    return 0;
  }
  const pw_interface *line = c->surface.line;
  int count = line->n + (line->closed ? 1 : 0);
  if (count > max) {
    return -1;
  }
  for (int k = 0; k < count; k++) {
    xy[2 * k] = line->node[k % line->n].x[0];
    xy[2 * k + 1] = line->node[k % line->n].x[1];
  }
  return count;
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, add_forces},
    {PW_STAGE_MESH, move_line},
    {0, NULL},
};

const pw_effect pw_effect_contact_corner = {
    .name = "contact_corner",
    .brief = "corners of the slave's CPDI domains on the master's surface, penalty and friction",
    .own_velocity_fields = true,
    .structure_key = "master",
    .point_fields = PW_FIELD_BIT(PW_FIELD_WAVE_SPEED) | PW_FIELD_BIT(PW_FIELD_CONTACT_SLIP) |
                    PW_FIELD_BIT(PW_FIELD_CONTACT_ARC) | PW_FIELD_BIT(PW_FIELD_CONTACT_OFFSET) |
                    PW_FIELD_BIT(PW_FIELD_CONTACT_STIFFNESS) | PW_FIELD_BIT(PW_FIELD_CONTACT_JUMP),
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .results = results,
    .archive = archive,
};
