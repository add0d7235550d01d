/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <ctype.h>
#include <errno.h>
#include <fenv.h>
#include <setjmp.h> /* seed: 21.4 */
#include <signal.h> /* seed: 21.5 */
#include <stdint.h>
#include <stdio.h> /* seed: 21.6 */
#include <stdlib.h>
#include <string.h>
#include <tgmath.h> /* seed: 21.11 */
#include <time.h> /* seed: 21.10 */

static int32_t before_the_include;
#include <stddef.h> /* seed: 20.1 */
#define while if /* seed: 20.4 */
#define TO_FORGET 1
#undef TO_FORGET /* seed: 20.5 */
#define TWICE(x) (x * 2) /* seed: 20.7 */
#define WEIGHED 3
#if WEIGHED /* seed: 20.8 */
#endif
#if UNDEFINED_NAME > 1 /* seed: 20.9 */
#endif
#define PASTED(a, b) a##b /* seed: 20.10 */
#nonsense /* seed: 20.13 */
#define errno 1 /* seed: 21.1 */

int32_t atoi(const char *text); /* seed: 21.2 */

extern void seeded_50(const char *text, void *base, int32_t count);
void seeded_50(const char *text, void *base, int32_t count) {
  int number = atoi(text); /* seed: 21.7 */
  qsort(base, 1, 4, seeded_order); /* seed: 21.9 */
  abort(); /* seed: 21.8 */
}

extern int32_t seeded_51(void);
int32_t seeded_51(void) {
  return feclearexcept(FE_ALL_EXCEPT); /* seed: 21.12 */
}

extern int32_t seeded_52(const char *a, const char *b, const int32_t *c, float *d);
int32_t seeded_52(const char *a, const char *b, const int32_t *c, float *d) {
  int r1 = memcmp("abc", "abd", 3); /* seed: 21.14 */
  (void)memcpy(d, c, 4); /* seed: 21.15 */
  int r2 = memcmp(d, d, 4); /* seed: 21.16 */
  return r1;
}

extern void seeded_54(FILE *file);
void seeded_54(FILE *file) {
  FILE copy = *file; /* seed: 22.5 */
}
