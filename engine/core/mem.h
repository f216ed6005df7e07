/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/mem.h
 * @brief Labelled, aligned, counted allocation; failure injection for tests (layer 0).
 *
 * Everything the library keeps is allocated here, at set-up. pw_mem_count() lets a test assert
 * that a step allocates nothing.
 * Not for use inside parallel regions.
 */
#ifndef PW_CORE_MEM_H
#define PW_CORE_MEM_H

#include "engine/core/status.h"

/**
 * @brief Allocate @p count elements of @p size bytes, PW_ALIGN-aligned, zeroed.
 * @param[in]  label static string naming the array in reports; kept by reference
 * @param[out] out   address of the pointer to set; set to NULL when count is 0 or on failure
 * @return PW_OK; PW_ERR_MEMORY with label and bytes in the error record.
 */
pw_status pw_mem_alloc(const char *label, pw_off count, size_t size, void *out);

/** @brief Free what @p ptr (the address of a pointer) points to and null it; NULL is accepted. */
void pw_mem_free(void *ptr);

/** @brief Allocations made since the program started. */
pw_off pw_mem_count(void);

/** @brief Bytes held now. */
pw_off pw_mem_bytes(void);

/** @brief Make the @p nth allocation from now fail (1 = the next); 0 switches injection off. */
void pw_mem_fail_after(pw_off nth);

#endif /* PW_CORE_MEM_H */
