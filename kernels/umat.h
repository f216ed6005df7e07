/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file kernels/umat.h
 * @brief Abaqus UMATs as the kernels see them: the arguments of a call, loaded routines, where the
 *        parameters of the material `umat` lie (layer 1).
 *
 * Source: the list of arguments of SUBROUTINE UMAT in the Abaqus User Subroutines Reference Guide.
 * Tensors of six components are in Abaqus' order 11 22 33 12 13 23, tension positive, with
 * engineering shear strains; matrices are column-major. The routines are found and called by
 * engine/umat.c; the table of loaded ones is shared by all simulations of the process, as the
 * libraries themselves are.
 */
#ifndef PW_KERNELS_UMAT_H
#define PW_KERNELS_UMAT_H

#include "kernels/material.h"

enum {
  PW_UMAT_LIBRARIES = 16, /**< loaded routines at most */
  PW_UMAT_OWN = 7,        /**< state of the host: STRAN and the stiffness so far */
  PW_UMAT_STATEV = PW_MAX_STATE - PW_UMAT_OWN,
  PW_UMAT_SPARE = 16, /**< numbers behind STATEV and PROPS that are no numbers */
  PW_UMAT_CMNAME = 80
};

/** Where the parameters lie; a list takes 1 + PW_LIST places, a text those of its bytes. */
enum {
  PW_UMAT_DENSITY,
  PW_UMAT_NPROPS,
  PW_UMAT_NSTATV,
  PW_UMAT_BOUND,
  PW_UMAT_LENGTH,
  PW_UMAT_THREAD_SAFE,
  PW_UMAT_UNCHANGED,
  PW_UMAT_MEASURE,
  PW_UMAT_FILE,
  PW_UMAT_SYMBOL = PW_UMAT_FILE + PW_FILE_NAME / 8,
  PW_UMAT_NAME = PW_UMAT_SYMBOL + PW_NAME / 8,
  PW_UMAT_PROPS = PW_UMAT_NAME + PW_NAME / 8,
  PW_UMAT_INITIAL = PW_UMAT_PROPS + 1 + PW_LIST,
  PW_UMAT_STRESS_LIKE = PW_UMAT_INITIAL + 1 + PW_LIST,
  PW_UMAT_STRAIN_LIKE = PW_UMAT_STRESS_LIKE + 1 + PW_LIST,
  PW_UMAT_PARAMS = PW_UMAT_STRAIN_LIKE + 1 + PW_LIST
};

/** The arguments of one call, in the order of the subroutine; all the routine's to overwrite. */
typedef struct pw_umat_call {
  pw_real stress[6]; /**< in and out; Pa */
  pw_real statev[PW_UMAT_STATEV + PW_UMAT_SPARE];
  pw_real ddsdde[36]; /**< out; Pa */
  pw_real sse, spd, scd, rpl, ddsddt[6], drplde[6], drpldt;
  pw_real stran[6], dstran[6]; /**< total strain before the increment, increment; - */
  pw_real time[2], dtime;      /**< at the start of the increment, its length; s */
  pw_real temp, dtemp, predef, dpred;
  char cmname[PW_UMAT_CMNAME];
  int32_t ndi, nshr, ntens, nstatv;
  pw_real props[PW_LIST + PW_UMAT_SPARE];
  int32_t nprops;
  pw_real coords[3], drot[9];
  pw_real pnewdt;
  pw_real celent, dfgrd0[9], dfgrd1[9];
  int32_t noel, npt, layer, kspt, kstep[4], kinc;
} pw_umat_call;

/** A loaded routine. */
typedef struct pw_umat pw_umat;
struct pw_umat {
  char file[PW_FILE_NAME], symbol[PW_NAME]; /**< as the scene names them */
  void (*entry)(void);                      /**< the subroutine, to be cast */
  /** @brief Call the subroutine. @return NULL, or why it gave up (STOP, XIT, an Abaqus error): a
   *  text that outlives the run. */
  const char *(*call)(const pw_umat *u, pw_umat_call *c);
  void (*enter)(void); /**< wait until no other thread is between enter() and leave() */
  void (*leave)(void);
};

/** @brief The loaded routine of that file and symbol, or NULL. */
const pw_umat *pw_umat_find(const char *file, const char *symbol);

/** @brief Add a routine; only while no simulation steps. @return false when there is no room. */
bool pw_umat_add(const pw_umat *umat);

/** @brief A text among the parameters of a material. */
const char *pw_umat_text(const pw_real *param, int index);

/** @brief Upper bound of the stiffness of plane waves; exact for isotropic ones; Pa.
 *  @param[in] ddsdde [36] column-major, engineering shear columns; Pa */
pw_real pw_umat_stiffness(const pw_real *ddsdde);

/**
 * @brief What a call has come to.
 * @param[in]  param parameters of the material
 * @param[in]  sent  the arguments as they were
 * @param[in]  c     the arguments as they came back
 * @param[out] over  set where a smaller increment will not help; else left alone
 * @return NULL; why the result cannot be taken.
 */
const char *pw_umat_judge(const pw_real *param, const pw_umat_call *sent, const pw_umat_call *c,
                          bool *over);

extern const pw_material pw_material_umat;

#endif /* PW_KERNELS_UMAT_H */
