/* Seeded violations for the compiler and its analyser: each line that ends in a seed comment must be found. */
#include <stdint.h>
#include <stddef.h>

int32_t seeded_70(int32_t value) { /* seed: -Wmissing-prototypes */
  int32_t result = value;
unused: /* seed: -Wunused-label */
  if (value > 1) {
    int32_t result = 2; /* seed: -Wshadow */
    value = result;
  }
  result = value + value++; /* seed: -Wsequence-point */
  value == 3; /* seed: -Wunused-value */
  return result;
}

static implicit_int = 1; /* seed: -Wimplicit-int */

static int32_t seeded_71(int32_t n) {
  int32_t list[n]; /* seed: -Wvla */
  list[0] = seeded_undeclared(n); /* seed: -Wimplicit-function-declaration */
  return list[0] + implicit_int;
}

static int32_t seeded_72(int32_t list[4]) {
  return (int32_t)sizeof(list) + seeded_71(1); /* seed: -Wsizeof-array-argument */
}

static int32_t seeded_73(void) {
  (void)seeded_72(NULL);
} /* seed: -Wreturn-type */

typedef int32_t (*reader_t)(int32_t n);
static void *seeded_74(reader_t reader) {
  int32_t (*other)(void) = (int32_t (*)(void))reader; /* seed: -Wcast-function-type */
  (void)other;
  (void)seeded_73();
  return (void *)reader; /* seed: -Wpedantic */
}

static void seeded_75(int32_t n, uint8_t *narrow) {
  *narrow = n; /* seed: -Wconversion */
}

int32_t *seeded_77(int32_t n);
int32_t *seeded_77(int32_t n) {
  int32_t local = n;
  (void)seeded_74(NULL);
  seeded_75(1, NULL);
  return &local; /* seed: -Wreturn-local-addr */
}
