/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effects/contact.h"

#include <stdio.h>

void pw_contact_tally_begin(pw_contact_tally *t)
{
  for (int i = 0; i < PW_REACTIONS; i++) {
    t->force[i] = 0.0;
  }
  t->overlap = 0.0;
  t->pairs = 0;
}

void pw_contact_tally_add(pw_contact_tally *t, const pw_real *force, bool tip)
{
  t->force[PW_REACTION_X] += force[0];
  t->force[PW_REACTION_Y] += force[1];
  t->force[tip ? PW_REACTION_TIP_Y : PW_REACTION_SHAFT_Y] += force[1];
}

void pw_contact_tally_end(pw_contact_tally *t, pw_real measure, pw_real dt)
{
  for (int i = 0; i < PW_REACTIONS; i++) {
    t->force[i] *= measure;
    t->impulse[i] += dt * t->force[i];
  }
  t->elapsed += dt;
  t->overlap_max = pw_max(t->overlap_max, t->overlap);
}

void pw_contact_tally_history(pw_contact_tally *t, pw_record *row)
{
  static const char *const name[PW_REACTIONS] = {"contact_force_x_n", "contact_force_y_n",
                                                 "contact_shaft_y_n", "contact_tip_y_n"};
  for (int i = 0; i < PW_REACTIONS; i++) {
    if (t->elapsed > 0.0) {
      t->mean[i] = t->impulse[i] / t->elapsed;
      t->impulse[i] = 0.0;
    }
    pw_record_put(row, name[i], t->mean[i]);
  }
  t->elapsed = 0.0;
  pw_record_put(row, "contact_overlap_max_m", t->overlap_max);
  pw_record_put(row, "contact_pairs", t->pairs);
}

pw_status pw_contact_tally_archive(pw_contact_tally *t, const char *name, pw_archive *ar)
{
  const struct {
    const char *name;
    pw_real *value;
    int count;
  } part[] = {{"force", t->force, PW_REACTIONS}, {"impulse", t->impulse, PW_REACTIONS},
              {"mean", t->mean, PW_REACTIONS},   {"elapsed", &t->elapsed, 1},
              {"overlap", &t->overlap, 1},       {"overlap_max", &t->overlap_max, 1}};
  char path[2 * PW_NAME];
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
    snprintf(path, sizeof path, "%s/%s", name, part[i].name);
    PW_TRY(ar->real(ar, path, part[i].value, part[i].count));
  }
  snprintf(path, sizeof path, "%s/pairs", name);
  return ar->index(ar, path, &t->pairs, 1);
}

const pw_contact_tally *pw_contact_tally_of(const pw_sim *sim)
{
  static const char *const name[] = {"contact_penalty", "contact_corner", "contact_frictional"};
  const void *ctx = NULL;
  for (size_t k = 0; !ctx && k < sizeof name / sizeof *name; k++) {
    ctx = pw_sim_effect_ctx(sim, name[k]);
  }
  return ctx;
}

pw_status pw_contact_check(const pw_scene *scene, int master, int slave)
{
  PW_REQUIRE(master >= 0 && slave >= 0 && master < scene->nbody && slave < scene->nbody,
             PW_ERR_SCENE, "master and slave must both name a body");
  PW_REQUIRE(master != slave, PW_ERR_SCENE, "master and slave must be two bodies");
  return PW_OK;
}
