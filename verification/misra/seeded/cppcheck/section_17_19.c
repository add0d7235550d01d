/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <stdarg.h>
#include <stdint.h>

extern int32_t seeded_40(int32_t depth);
int32_t seeded_40(int32_t depth) {
  return seeded_40(depth - 1); /* seed: 17.2 */
}

extern int32_t seeded_41(int32_t a, ...);
int32_t seeded_41(int32_t a, ...) {
  va_list rest; /* seed: 17.1 */
  va_start(rest, a);
  va_end(rest);
  return a;
}

extern int32_t seeded_42(int32_t list[static 2]); /* seed: 17.6 */

extern void seeded_43(int32_t a);
void seeded_43(int32_t a) {
  seeded_41(a); /* seed: 17.7 */
  a = 2; /* seed: 17.8 */
}

extern int32_t seeded_44(int32_t *where, int32_t n);
int32_t seeded_44(int32_t *where, int32_t n) {
  int32_t *next = where + n; /* seed: 18.4 */
  int32_t ***deep; /* seed: 18.5 */
  int32_t list[n]; /* seed: 18.8 */
  return *next;
}

typedef struct {
  int32_t count;
  int32_t items[]; /* seed: 18.7 */
} flexible_t;

typedef union { /* seed: 19.2 */
  int32_t word;
  float real;
} either_t;
