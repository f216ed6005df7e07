/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/points.h
 * @brief Material points as structure of arrays; only the fields a scene asks for exist (layer 3).
 *
 * Component c of point i of a field is at [c * ld + i]; ld is n padded to PW_LANES. Points are
 * sorted by (block, body); their order changes when they are sorted again, their id does not.
 * Axisymmetric scenes: x = r, y = z (axial), component zz = hoop, masses and volumes per radian.
 */
#ifndef PW_ENGINE_POINTS_H
#define PW_ENGINE_POINTS_H

#include "engine/core/archive.h"
#include "engine/core/status.h"

typedef enum pw_field_id {
#define PW_FIELD(ID, member, type, ncomp, unit, restart, always, meaning) PW_FIELD_##ID,
#include "engine/fields.def"
#undef PW_FIELD
  PW_FIELD_COUNT
} pw_field_id;

#define PW_FIELD_BIT(id) (UINT64_C(1) << (id))

typedef pw_real pw_field_real;
typedef pw_idx pw_field_idx;

typedef struct pw_points {
  pw_idx n;        /**< points */
  pw_idx ld;       /**< leading dimension of every field */
  uint64_t fields; /**< bit set of the fields that exist */
  int nstate;      /**< components of state */
  int vertices;    /**< vertices of the basis: components of corner; local has twice as many */
  pw_idx *slot;    /**< [n] where the point of an id stands now: slot[id] */
#define PW_FIELD(ID, member, type, ncomp, unit, restart, always, meaning) pw_field_##type *member;
#include "engine/fields.def"
#undef PW_FIELD
} pw_points;

/** What a loop over fields (checkpoint, ParaView, permutation) needs to know of one of them. */
typedef struct pw_field_info {
  const char *name; /**< member name, "stress" */
  const char *unit;
  const char *meaning;
  int ncomp;
  bool is_real; /**< pw_real, else pw_idx */
  bool restart;
  void *array; /**< [ncomp][ld]; NULL when the field is not in the scene */
} pw_field_info;

/**
 * @brief Allocate @p n points with the fields of @p fields (bits of pw_field_id) and those marked
 *        `always`. Values are zero but id and slot (identity).
 * @return PW_OK; PW_ERR_MEMORY; PW_ERR_ARGUMENT when n < 0.
 */
pw_status pw_points_create(pw_idx n, uint64_t fields, int nstate, int vertices, pw_points *out);

/** @brief Free all fields; a zeroed struct is accepted. */
void pw_points_destroy(pw_points *p);

/** @brief Describe field @p id. */
pw_field_info pw_points_field(const pw_points *p, pw_field_id id);

/** @brief Bytes of all fields of one point. */
pw_off pw_points_bytes_per_point(const pw_points *p);

/**
 * @brief Reorder every field: new point i is old point from[i]; slot is renewed.
 * @param[in] from    [n] a permutation
 * @param[in] scratch [ld] pw_real
 */
void pw_points_permute(pw_points *p, const pw_idx *from, pw_real *scratch);

/** @brief Save or load all restart fields under "points/". @return as the archive's calls. */
pw_status pw_points_archive(pw_points *p, pw_archive *ar);

#endif /* PW_ENGINE_POINTS_H */
