/* Seeded violations for the text scan: each line that ends in a seed comment must be found. */
#include <stdio.h> /* seed: scan include */

#define SEEDED_SQUARE(x) ((x) * (x)) /* seed: scan function-macro */

static unsigned seeded_100; /* seed: scan plain-type */

static void seeded_101(void) {
  __asm__("nop"); /* seed: scan assembler */
}

static void seeded_102(void) {
  FILE *file = fopen("x", "r"); /* seed: scan file */
}

static void (*seeded_103)(void); /* seed: scan function-pointer */
/* cppcheck-suppress seed: scan suppression */
