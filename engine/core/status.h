/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/status.h
 * @brief Status codes with a meaning for the time step, and the last-error record (layer 0).
 *
 * 0 is success; positive codes mean that a smaller step may help; negative codes mean stop. The
 * library never prints, exits or aborts: the text and the place of the failure are kept in a
 * record per thread, read with pw_error_text(). Code inside OpenMP loops reduces failures to an
 * index and lets the calling thread set the record.
 */
#ifndef PW_CORE_STATUS_H
#define PW_CORE_STATUS_H

#include "engine/core/types.h"

typedef enum pw_status {
#define PW_STATUS(code, value, text) code = value,
#include "engine/core/status.def"
#undef PW_STATUS
} pw_status;

/** @brief Text of a code; never NULL. */
const char *pw_status_text(pw_status s);

/** @brief Record an error for this thread; returns @p s so that it can be returned at once. */
pw_status pw_error_set(pw_status s, const char *file, int line, const char *func, const char *fmt,
                       ...) __attribute__((format(printf, 5, 6)));

/** @brief Message of this thread's last error; "" if there was none. */
const char *pw_error_text(void);

/** @brief Where it was raised, as "file:line function"; "" if there was none. */
const char *pw_error_where(void);

void pw_error_clear(void);

/** Return early when @p call does not give PW_OK. */
#define PW_TRY(call)                                                                               \
  do {                                                                                             \
    pw_status pw_try_status_ = (call);                                                             \
    if (pw_try_status_ != PW_OK) {                                                                 \
      return pw_try_status_;                                                                       \
    }                                                                                              \
  } while (0)

/** Record and return @p code with a message when @p cond is false. */
#define PW_REQUIRE(cond, code, ...)                                                                \
  do {                                                                                             \
    if (!(cond)) {                                                                                 \
      return pw_error_set(code, __FILE__, __LINE__, __func__, __VA_ARGS__);                        \
    }                                                                                              \
  } while (0)

#endif /* PW_CORE_STATUS_H */
