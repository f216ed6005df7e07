/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/element_test.h
 * @brief Laboratory tests on one element of a material: stages one after another (layer 3).
 *
 * The axis of the tests is y, tension is positive; strains are logarithmic (integrals of the rate
 * of deformation), the shear strain of simple shear is the engineering one.
 */
#ifndef PW_ENGINE_ELEMENT_TEST_H
#define PW_ENGINE_ELEMENT_TEST_H

#include "engine/scene.h"
#include "kernels/element_driver.h"

enum { PW_MAX_STAGES = 32 };

typedef enum pw_stage_kind {
  PW_STAGE_ISOTROPIC,    /**< equal normal strains or stresses */
  PW_STAGE_OEDOMETRIC,   /**< no lateral strain */
  PW_STAGE_TRIAXIAL,     /**< equal lateral stresses, held; undrained: no change of volume */
  PW_STAGE_BIAXIAL,      /**< no strain along z, sigma_xx held; undrained: no change of volume */
  PW_STAGE_SIMPLE_SHEAR, /**< no strain along x and z, sigma_yy held; undrained: nor along y */
  PW_STAGE_MIXED,        /**< every component by strain or by stress */
  PW_STAGE_PATH,         /**< strains from a CSV file */
} pw_stage_kind;

/** A stage; it begins where the one before it ended. */
typedef struct pw_element_stage {
  int kind; /**< pw_stage_kind */
  bool drained;
  pw_reals to_strain;    /**< turning points, strain since the start of the stage */
  pw_reals to_stress_pa; /**< turning points, stress; one of the two lists is given */
  pw_reals mixed_stress; /**< [6] 1 where mixed_target is a stress */
  pw_reals mixed_target; /**< [6] strain since the start of the stage, or stress in Pa */
  char file[PW_NAME];    /**< of PW_STAGE_PATH, relative to the test's file */
  int npath;
  const pw_real (*path)[9]; /**< [npath] strains xx yy zz xy yz zx (tensor shears) and spins xy yz
                               zx (rad) since the start of the stage; borrowed */
  int cycles;               /**< times the turning points are run through */
  int steps;                /**< between two turning points */
} pw_element_stage;

/** An element test. */
typedef struct pw_element_test {
  char title[PW_NAME];
  char file[256]; /**< where it was read from */
  pw_scene_material material;
  pw_real stress_pa[6]; /**< at the start */
  pw_real height_y_m;   /**< for models that depend on depth */
  bool pictures;
  int nstage;
  pw_element_stage stage[PW_MAX_STAGES];
} pw_element_test;

/** What the element is after a step. */
typedef struct pw_element_row {
  int stage, step;      /**< counted from 1; 0: the start */
  pw_real pore_pa;      /**< excess pore pressure that keeps the volume; Pa */
  const pw_element *el; /**< borrowed */
} pw_element_row;

/** Called at the start and after each step. @return PW_OK to go on. */
typedef pw_status (*pw_element_report)(void *ctx, const pw_element_row *row);

/**
 * @brief Run all stages of a test.
 * @return PW_OK; PW_RETRY_DIVERGED with stage and step when a step cannot be made; what @p report
 *         returns.
 */
pw_status pw_element_test_run(const pw_element_test *t, pw_element_report report, void *ctx);

/** @brief Mobilised Mohr-Coulomb friction angle of a stress; 90 when a principal stress is not
 *  compressive, 0 for isotropic ones; degrees. @param[in] stress [6] Pa */
pw_real pw_element_friction_angle(const pw_real *stress);

#endif /* PW_ENGINE_ELEMENT_TEST_H */
