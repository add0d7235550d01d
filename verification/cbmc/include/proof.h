/**
 * @file
 * Words in which the harnesses state what they show.
 *
 * A variable of a harness that is declared without a value is arbitrary: that is how CBMC reads it.
 */
#ifndef ILK_PROOF_H
#define ILK_PROOF_H

#include <stdbool.h>

#include "interlock/types.h"

/** The kernel must make this true. The text names the property. */
#define SHOW(claim, text) __CPROVER_assert(claim, text)

/** What the harness takes for granted. */
#define GIVEN(condition) __CPROVER_assume(condition)

/** A goal by name: proof.toml says whether it must be reachable, or must be impossible. */
#ifdef ILK_COVER
#define GOAL(name, condition)      \
  do {                             \
    const bool name = (condition); \
    __CPROVER_cover(name);         \
  } while (false)
#else
#define GOAL(name, condition) ((void)0)
#endif

#define IMPLIES(antecedent, consequent) (!(antecedent) || (consequent))

#endif
