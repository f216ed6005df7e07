/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A force on a corner of a domain, or on an edge's middle, does the work of the nodal forces it is
 * handed to, for any domain and any velocity of the grid, in the plane and in axisymmetry. Shares
 * of the surface add up to it. Reference: virtual work with the engine's own motion of domains;
 * integrals by hand. */
#include "engine/assemble.h"
#include "engine/domain_sites.h"
#include "engine/update.h"
#include "tests/engine_helpers.h"

/* A few domains, each with random half-sides that keep its area positive. */
static pw_sim *domains(int geometry, uint64_t *seed)
{
  static pw_scene s; /* large */
  pw_scene_default(&s);
  s.geometry = geometry;
  test_grid(&s, (pw_real[]){0.0, 2.0, 0.0, 2.0}, 0.25);
  test_rectangle(&s, test_elastic(&s, 1e6, 0.2, 1000.0), (pw_real[]){0.0, 2.0, 0.5, 1.5}, 0.25);
  pw_sim *sim = test_sim(&s, 1);
  pw_points *p = &sim->points;
  for (pw_idx i = 0; i < p->n; i++) {
    for (int k = 0; k < 4; k++) {
      p->half[k * p->ld + i] += 0.08 * (test_random(seed) - 0.5);
    }
  }
  for (pw_idx b = 0; b < sim->blocks.nblock; b++) {
    pw_block_weights(sim, b);
  }
  for (pw_off k = 0; k < (pw_off)sim->mesh.nnode * PW_NODE; k++) {
    sim->nodes.rec[k] = 2.0 * test_random(seed) - 1.0;
    sim->nodes.rec[k] = k % PW_NODE == PW_NODE_MASS ? 1.0 : sim->nodes.rec[k];
  }
  return sim;
}

/* Place of a site after the step dt, as the engine moves domains: centre by its mean, half-sides by
 * the gradient. */
static void moved(const pw_sim *sim, pw_idx i, int site, pw_real dt, pw_real *x)
{
  static pw_gradients g;
  pw_points *p = (pw_points *)&sim->points;
  pw_domain_now d = pw_domain_of(p, i, sim->scene.geometry == PW_AXI);
  const pw_real keep[2] = {p->x[i], p->x[p->ld + i]};
  sim->kernels->g2p_gradient(&sim->transfer, sim->nodes.rec, PW_NODE_VEL, dt, true, i, i + 1, &g);
  for (int a = 0; a < 2; a++) {
    d.x[a] = p->x[a * p->ld + i];
    p->x[a * p->ld + i] = keep[a];
    for (int side = 0; side < 2; side++) {
      const pw_real *r = p->half + 2 * side * p->ld + i;
      d.r[2 * side + a] += g.du[2 * a][0] * r[0] + g.du[2 * a + 1][0] * r[p->ld];
    }
  }
  pw_site_place(&d, site, x);
}

static void check_work(int geometry)
{
  uint64_t seed = 7;
  pw_sim *sim = domains(geometry, &seed);
  const pw_points *p = &sim->points;
  pw_real *rec = sim->nodes.rec, worst = 0.0;
  for (pw_idx i = 0; i < p->n; i++) {
    pw_domain_now d = pw_domain_of(p, i, geometry == PW_AXI);
    for (int site = 0; site < PW_SITES; site++) {
      const pw_real dt = 0.01, f[2] = {3.0 * test_random(&seed) - 1.5, test_random(&seed) - 0.5};
      pw_real from[2], to[2], v[2], work = 0.0;
      for (pw_off k = 0; k < sim->mesh.nnode; k++) {
        rec[k * PW_NODE + PW_NODE_FORCE] = rec[k * PW_NODE + PW_NODE_FORCE + 1] = 0.0;
      }
      pw_site_scatter(p, &d, site, sim->mesh.nodes[0], f, rec);
      for (pw_off k = 0; k < sim->mesh.nnode; k++) {
        const pw_real *r = rec + k * PW_NODE;
        work += r[PW_NODE_FORCE] * r[PW_NODE_VEL] + r[PW_NODE_FORCE + 1] * r[PW_NODE_VEL + 1];
      }
      pw_site_place(&d, site, from);
      moved(sim, i, site, dt, to);
      if (from[0] > 0.0 && to[0] > 0.0) { /* across the axis a site counts as on it */
        pw_real done = f[0] * (to[0] - from[0]) + f[1] * (to[1] - from[1]);
        worst = pw_max(worst, fabs(done - dt * work));
      }
      pw_site_velocity(p, &d, site, sim->mesh.nodes[0], 0.0, rec, v);
      assert_near(f[0] * v[0] + f[1] * v[1], work, 1e-13);
    }
  }
  print_message("%s: largest difference of work %.1e J\n", geometry == PW_AXI ? "axi" : "plane",
                worst);
  assert_true(worst < 1e-15); /* of works of some 1e-2 J */
  pw_sim_destroy(&sim);
}

static void work_is_that_of_the_grid(void **state)
{
  (void)state;
  check_work(PW_PLANE);
  check_work(PW_AXI);
}

/* The mass with which a site answers on the grid is never below the bound. */
static void grid_is_never_lighter_than_the_bound(void **state)
{
  (void)state;
  uint64_t seed = 11;
  for (int geometry = PW_PLANE; geometry <= PW_AXI; geometry++) {
    pw_sim *sim = domains(geometry, &seed);
    const pw_points *p = &sim->points;
    pw_nodes_clear(&sim->nodes);
    pw_assemble_coloured(&sim->blocks, 1, pw_block_p2g, sim);
    for (pw_idx i = 0; i < p->n; i++) {
      pw_domain_now d = pw_domain_of(p, i, geometry == PW_AXI);
      for (int site = 0; site < PW_SITES; site++) {
        const pw_real unit[2] = {1.0, 0.0};
        pw_real inverse = 0.0;
        for (pw_off k = 0; k < sim->mesh.nnode; k++) {
          sim->nodes.rec[k * PW_NODE + PW_NODE_FORCE] = 0.0;
        }
        pw_site_scatter(p, &d, site, sim->mesh.nodes[0], unit, sim->nodes.rec);
        for (pw_off k = 0; k < sim->mesh.nnode; k++) {
          const pw_real *r = sim->nodes.rec + k * PW_NODE;
          inverse +=
              r[PW_NODE_MASS] > 0.0 ? r[PW_NODE_FORCE] * r[PW_NODE_FORCE] / r[PW_NODE_MASS] : 0.0;
        }
        assert_true(inverse <= pw_site_inverse_mass(&d, site, p->mass[i]) * (1.0 + 1e-12));
      }
    }
    pw_sim_destroy(&sim);
  }
}

/* Areas of the lower edge of an aligned domain: w in the plane, the integral of r dr in
 * axisymmetry; of a vertical edge r w; the slope of the other edge does not count. */
static void areas_add_up(void **state)
{
  (void)state;
  const pw_real w = 0.3, up[2] = {0.0, 1.0}, left[2] = {-1.0, 0.0};
  pw_domain_now d = {.x = {0.5, 2.0}, .r = {0.5 * w, 0.0, 0.4, 0.1}};
  pw_real sum = pw_site_area(&d, 0, up) + pw_site_area(&d, 4, up) + pw_site_area(&d, 1, up);
  assert_near(sum, w, 1e-15);
  d = (pw_domain_now){.x = {0.5 * w, 2.0}, .r = {0.5 * w, 0.0, 0.0, 0.1}, .axi = true};
  sum = pw_site_area(&d, 0, up) + pw_site_area(&d, 4, up) + pw_site_area(&d, 1, up);
  assert_near(sum, 0.5 * w * w, 1e-15);
  d.x[0] = 0.5;
  sum = pw_site_area(&d, 0, left) + pw_site_area(&d, 7, left) + pw_site_area(&d, 3, left);
  assert_near(sum, 0.2 * (0.5 - 0.5 * w), 1e-15);
  /* A square on its corner: the mean of its two edges. */
  d = (pw_domain_now){.r = {0.1, 0.1, -0.1, 0.1}};
  assert_near(pw_site_area(&d, 0, up), 0.05, 1e-15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(work_is_that_of_the_grid),
      cmocka_unit_test(grid_is_never_lighter_than_the_bound),
      cmocka_unit_test(areas_add_up),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
