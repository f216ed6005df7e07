/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What velocities that the grid does not see do to sand with intergranular strain: a column of
 * 1.25 m radius and 10 m height gets its weight in 2 s while its points carry random velocities at
 * the start. Prints, every 0.25 s, the vertical stress over that of the weight (mean over heights
 * of 1 to 9 m) in rings of one point's width: at the axis and out to the wall.
 *   bench_noise [noise_m_s (1e-3)] [noise_damping_per_s (0)] [cfl (0.5)] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench/sand.h"
#include "engine/sim_state.h"

enum { RINGS = 20 };

static const double RAMP = 2.0, G = 10.0, TOP = 10.0, CELL = 0.125;

static void column(pw_scene *s, double damping, double cfl)
{
  pw_scene_default(s);
  s->geometry = PW_AXI;
  s->grid.size_m[0] = 1.25;
  s->grid.size_m[1] = 10.5;
  s->grid.cell_m = CELL;
  s->time.cfl = cfl;
  s->method.noise_damping_per_s = damping;
  bench_sand(&s->material[s->nmaterial++], true);
  s->body[s->nbody++] = (pw_scene_body){.name = "soil",
                                        .shape = PW_SHAPE_RECTANGLE,
                                        .x_m = {0.0, 1.25},
                                        .y_m = {0.0, TOP},
                                        .point_size_m = 0.5 * CELL};
  pw_gravity_param *g = pw_scene_add_effect(s, "gravity");
  g->acceleration_m_s2 = G;
  g->ramp_s = RAMP;
  pw_boundary_param *base = pw_scene_add_effect(s, "boundary");
  base->side = PW_SIDE_BOTTOM;
  base->fix_x = base->fix_y = true;
  base->body = -1;
  pw_boundary_param *side = pw_scene_add_effect(s, "boundary");
  side->side = PW_SIDE_RIGHT;
  side->fix_x = true;
  side->body = -1;
}

static void print_rings(const pw_sim *sim)
{
  const pw_points *p = &sim->points;
  double sum[RINGS] = {0.0}, top = 0.0, weight = G * fmin(1.0, sim->time / RAMP);
  int count[RINGS] = {0};
  for (pw_idx i = 0; i < p->n; i++) {
    top = fmax(top, p->x[p->ld + i] + 0.25 * CELL);
  }
  for (pw_idx i = 0; i < p->n; i++) {
    double y = p->x[p->ld + i];
    int ring = (int)fmin(RINGS - 1, p->x[i] / (0.5 * CELL));
    if (y > 1.0 && y < 9.0) {
      sum[ring] += p->stress[p->ld + i] / (-2600.0 / 1.65 * weight * (top - y));
      count[ring]++;
    }
  }
  printf("t %.2f s, step %lld, dt %.2e s:", sim->time, (long long)sim->step, sim->dt);
  for (int r = 0; r < RINGS; r += r < 3 ? 1 : 4) {
    printf("  ring %d %.3f", r, count[r] > 0 ? sum[r] / count[r] : 0.0);
  }
  printf("\n");
  fflush(stdout);
}

int main(int argc, char **argv)
{
  static pw_scene scene;
  pw_sim *sim = NULL;
  double noise = argc > 1 ? atof(argv[1]) : 1e-3, next = 0.25;
  column(&scene, argc > 2 ? atof(argv[2]) : 0.0, argc > 3 ? atof(argv[3]) : 0.5);
  pw_status status = pw_sim_create(&scene, 1, &sim);
  srand(1);
  for (pw_idx i = 0; status == PW_OK && i < sim->points.n; i++) {
    sim->points.v[i] += noise * (rand() / (double)RAND_MAX - 0.5);
  }
  while (status == PW_OK && next < RAMP + 0.1) {
    status = pw_sim_step(sim, next - sim->time);
    if (status == PW_OK && sim->time >= next * (1.0 - 1e-12)) {
      print_rings(sim);
      next += 0.25;
    }
  }
  if (status != PW_OK) {
    fprintf(stderr, "%s\n", pw_error_text());
  }
  pw_sim_destroy(&sim);
  return status == PW_OK ? 0 : 1;
}
