/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Penalty contact between two bodies along interface lines (thesis sections 2.6.4-2.6.8). */
#include "engine/effects/contact_penalty.h"

#include "engine/core/mem.h"
#include "engine/full_mass.h"

#define AT(member) offsetof(pw_contact_penalty_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"master", PW_KEY_BODY, AT(master), 0, 0, NULL, NULL, NULL,
   "stiff body whose surface pushes: pile, plane"},
  {"slave", PW_KEY_BODY, AT(slave), 0, 0, NULL, NULL, NULL,
   "body whose interface nodes stay outside the master: soil, cylinder"},
  {"friction", PW_KEY_REAL, AT(friction), 0, 1e6, NULL, NULL, NULL,
   "Coulomb's coefficient"},
  {"normal_stiffness_pa_m", PW_KEY_REAL, AT(normal_stiffness_pa_m), PW_TINY, 1e20, NULL, NULL, NULL,
   "contact pressure per metre of overlap"},
  {"tangential_stiffness_pa_m", PW_KEY_REAL, AT(tangential_stiffness_pa_m), 0, 1e20, "0", NULL, NULL,
   "shear stress per metre of elastic slip; 0: the normal stiffness"},
  {"segment_m", PW_KEY_REAL, AT(segment_m), 0, 1e6, "0", NULL, NULL,
   "largest length of interface segments, at most a cell; 0: half a cell"},
  {"thickness_m", PW_KEY_REAL, AT(thickness_m), 0, 1e3, "0.001", NULL, NULL,
   "thickness of the layer whose mass interface nodes carry"},
  {"split_factor", PW_KEY_REAL, AT(split_factor), 1.1, 100, "1.5", NULL, NULL,
   "slave segments longer than this many segment_m are split"},
  {"thin_factor", PW_KEY_REAL, AT(thin_factor), 0, 1, "0.4", NULL, NULL,
   "slave segments shorter than this many segment_m are merged; at most 0.45 split_factor"},
  {"step_frequency_max", PW_KEY_REAL, AT(step_frequency_max), PW_TINY, 0.7, "0.2", NULL, NULL,
   "largest step times the frequency of the springs; longer ones need fewer steps, 2 is unstable"},
  {"guard_depth_m", PW_KEY_REAL, AT(guard_depth_m), 0, 1e3, "0", NULL, NULL,
   "springs on points that leak through the slave's line deeper into the master; none may be there "
   "at the start; 0: no springs"},
  {0}};
/* clang-format on */

static pw_real segment_length(const pw_scene *scene, const pw_contact_penalty_param *p)
{
  return p->segment_m > 0.0 ? p->segment_m : 0.5 * scene->grid.cell_m;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_contact_penalty_param *p = param;
  PW_TRY(pw_contact_check(scene, p->master, p->slave));
  PW_REQUIRE(p->segment_m <= scene->grid.cell_m * (1.0 + 1e-9), PW_ERR_SCENE,
             "segment_m = %g must not be longer than a cell, %g m", p->segment_m,
             scene->grid.cell_m);
  PW_REQUIRE(
      p->thin_factor <= 0.45 * p->split_factor, PW_ERR_SCENE,
      "thin_factor = %g must be at most 0.45 split_factor, %g, or split segments merge again",
      p->thin_factor, 0.45 * p->split_factor);
  const pw_scene_body *master = &scene->body[p->master];
  PW_REQUIRE(p->guard_depth_m <= 0.0 || scene->method.step_ratio_max <= 1, PW_ERR_SCENE,
             "guard_depth_m: not with step_ratio_max = %d", (int)scene->method.step_ratio_max);
  PW_REQUIRE(p->guard_depth_m <= 0.0 || master->shape != PW_SHAPE_RING, PW_ERR_SCENE,
             "guard_depth_m: not with '%s', whose hole would count as its inside", master->name);
  return PW_OK;
}

/* The records and constraints of the present step. */
static void bind_fields(pw_sim *sim, pw_penalty *c)
{
  const int body[2] = {c->param->slave, c->param->master};
  for (int side = 0; side < 2; side++) {
    c->rec[side] = pw_nodes_field(&sim->nodes, sim->body[body[side]].field);
    c->given[side] = sim->body[body[side]].prescribed;
  }
}

static pw_status scatter_lines(pw_sim *sim, void *ctx)
{
  pw_penalty *c = ctx;
  pw_interface *line[2] = {&c->slave, &c->master};
  bind_fields(sim, c);
  for (int side = 0; side < 2; side++) {
    if (c->given[side]) {
      pw_interface_set_velocity(line[side], sim->body[line[side]->body].prescribed_v);
    }
    pw_interface_locate(line[side], &sim->mesh);
    pw_interface_use(line[side], &sim->nodes, sim->body[line[side]->body].field);
    pw_interface_p2g(line[side], c->rec[side]);
  }
  return PW_OK;
}

static pw_status add_forces(pw_sim *sim, void *ctx)
{
  pw_penalty *c = ctx;
  pw_interface_weights(&c->slave, c->rec[0], sim->mass_cut_off);
  pw_interface_weights(&c->master, c->rec[1], sim->mass_cut_off);
  pw_bins_fill(&c->bins, &c->master);
  c->spring = 0.0;
  c->dissipated = 0.0;
  pw_contact_tally_begin(&c->tally);
  pw_penalty_search(c, sim->mesh.cell);
  sim->dt_contact = pw_penalty_limit(c, sim->nodes.nnode, sim->dt);
  pw_penalty_forces(c);
  if (c->param->guard_depth_m > 0.0) {
    const pw_real dt = pw_penalty_guard(sim, c);
    sim->dt_contact = dt > 0.0 && sim->dt_contact > 0.0 ? pw_min(dt, sim->dt_contact)
                                                        : pw_max(dt, sim->dt_contact);
  }
  pw_contact_tally_end(&c->tally, sim->measure, sim->dt);
  sim->energy.spring += sim->measure * c->spring;
  sim->energy.contact += sim->measure * c->dissipated;
  return PW_OK;
}

static pw_status scatter_mass(pw_sim *sim, void *ctx)
{
  pw_penalty *c = ctx;
  pw_interface *line[2] = {&c->slave, &c->master};
  for (int side = 0; side < 2; side++) {
    const int field = sim->body[line[side]->body].field;
    pw_interface_mass(line[side], pw_full_mass_field(sim->full_mass, field, sim->nodes.nnode));
  }
  return PW_OK;
}

static pw_status scatter_remap(pw_sim *sim, void *ctx)
{
  (void)sim;
  pw_penalty *c = ctx;
  pw_interface_velocity(&c->slave, c->rec[0], false);
  pw_interface_velocity(&c->master, c->rec[1], false);
  pw_interface_remap(&c->slave, c->rec[0]);
  pw_interface_remap(&c->master, c->rec[1]);
  return PW_OK;
}

static pw_status move_lines(pw_sim *sim, void *ctx)
{
  pw_penalty *c = ctx;
  const bool musl = sim->scene.method.update == PW_MUSL;
  pw_interface *line[2] = {&c->slave, &c->master};
  for (int side = 0; side < 2; side++) {
    if (c->given[side]) {
      pw_interface_move_rigid(line[side], sim->dt);
      continue;
    }
    if (!musl) {
      pw_interface_velocity(line[side], c->rec[side], true);
    }
    pw_interface_move(line[side], c->rec[side], sim->node_slot, sim->dt);
  }
  c->counts.released = 0.0;
  pw_interface_refine(&c->slave, &c->rule, &c->counts);
  sim->energy.contact += sim->measure * c->counts.released;
  return PW_OK;
}

static pw_status build(pw_sim *sim, const pw_contact_penalty_param *p, pw_penalty *c)
{
  const pw_real segment = segment_length(&sim->scene, p);
  c->param = p;
  c->omega_n = p->normal_stiffness_pa_m;
  c->omega_t = p->tangential_stiffness_pa_m > 0.0 ? p->tangential_stiffness_pa_m : c->omega_n;
  c->rule = (pw_refine_rule){p->split_factor * segment, p->thin_factor * segment};
  PW_TRY(
      pw_interface_from_body(&sim->scene, p->slave, p->master, segment, p->thickness_m, &c->slave));
  PW_TRY(pw_interface_from_body(&sim->scene, p->master, -1, segment, p->thickness_m, &c->master));
  PW_TRY(pw_bins_create(&c->master, &sim->mesh, &c->bins));
  PW_TRY(pw_penalty_guard_check(sim, c));
  PW_TRY(pw_mem_alloc("contact pairs", c->slave.capacity, sizeof *c->pair, &c->pair));
  return pw_mem_alloc("contact stiffness", 2 * (pw_off)sim->mesh.nnode, sizeof(pw_real),
                      &c->stiffness);
}

static void destroy(void **ctx)
{
  pw_penalty *c = *ctx;
  if (c) {
    pw_interface_destroy(&c->slave);
    pw_interface_destroy(&c->master);
    pw_bins_destroy(&c->bins);
    pw_mem_free(&c->pair);
    pw_mem_free(&c->stiffness);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  pw_penalty *c;
  PW_TRY(pw_mem_alloc("contact_penalty", 1, sizeof *c, &c));
  *ctx = c;
  return build(sim, param, c);
}

static void history(const pw_sim *sim, void *ctx, pw_record *row)
{
  (void)sim;
  pw_penalty *c = ctx;
  pw_contact_tally_history(&c->tally, row);
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  (void)sim;
  const pw_penalty *c = ctx;
  pw_record_put(out, "contact_overlap_max_m", c->tally.overlap_max);
  pw_record_put(out, "contact_segments", (pw_real)pw_interface_segments(&c->slave));
  pw_record_put(out, "contact_splits", (pw_real)c->counts.splits);
  pw_record_put(out, "contact_merges", (pw_real)c->counts.merges);
  pw_record_put(out, "contact_splits_refused", (pw_real)c->counts.refused);
  pw_record_put(out, "contact_stiffness_reduced", (pw_real)c->reduced);
  pw_record_put(out, "contact_pairs_detached", (pw_real)c->detached);
  if (c->param->guard_depth_m > 0.0) {
    pw_record_put(out, "contact_guarded_point_steps", (pw_real)c->guarded);
  }
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  (void)sim;
  pw_penalty *c = ctx;
  pw_off count[5] = {c->counts.splits, c->counts.merges, c->counts.refused, c->reduced,
                     c->detached};
  PW_TRY(pw_contact_tally_archive(&c->tally, "contact_penalty/reaction", ar));
  PW_TRY(pw_interface_archive(&c->slave, "contact_penalty/slave", ar));
  PW_TRY(pw_interface_archive(&c->master, "contact_penalty/master", ar));
  for (pw_idx k = 0; ar->loading && k < c->slave.n; k++) {
    const pw_idx owner = c->slave.node[k].touch.owner;
    PW_REQUIRE(owner >= -1 && owner < pw_interface_segments(&c->master), PW_ERR_FILE,
               "the checkpoint's contacts of contact_penalty are damaged");
  }
  if (c->param->guard_depth_m > 0.0) {
    PW_TRY(ar->offset(ar, "contact_penalty/guarded", &c->guarded, 1));
  }
  PW_TRY(ar->offset(ar, "contact_penalty/counts", count, 5));
  c->counts = (pw_refine_counts){count[0], count[1], count[2], 0.0};
  c->reduced = count[3];
  c->detached = count[4];
  return PW_OK;
}

int pw_contact_outline(const pw_sim *sim, int which, pw_real *xy, int max)
{
  const pw_penalty *c = pw_sim_effect_ctx(sim, "contact_penalty");
  if (!c || which < 0 || which > 1) {
    return 0;
  }
  const pw_interface *line = which == 0 ? &c->master : &c->slave;
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
    {PW_STAGE_P2G, scatter_lines}, {PW_STAGE_NODE_FORCE, add_forces},
    {PW_STAGE_MASS, scatter_mass}, {PW_STAGE_REMAP_P2G, scatter_remap},
    {PW_STAGE_MESH, move_lines},   {0, NULL},
};

const pw_effect pw_effect_contact_penalty = {
    .name = "contact_penalty",
    .brief = "interface lines with normal penalty and Coulomb friction (Giridharan 2016, 2.6.4)",
    .own_velocity_fields = true,
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .history = history,
    .results = results,
    .archive = archive,
};
