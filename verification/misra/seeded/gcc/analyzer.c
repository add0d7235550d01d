/* Seeded violations for gcc's analyser: each line that ends in a seed comment must be found. */
#include <stdint.h>
#include <stdlib.h>

int32_t seeded_78(int32_t n);
int32_t seeded_78(int32_t n) {
  int32_t never_set;
  if (n > 1) {
    never_set = 1;
  }
  return never_set; /* seed: -Wanalyzer-use-of-uninitialized-value */
}

void seeded_79(void);
void seeded_79(void) {
  char *memory = malloc(4u);
  memory[0] = 'a'; /* seed: -Wanalyzer-possible-null-dereference */
  free(memory);
  free(memory); /* seed: -Wanalyzer-double-free */
}

void seeded_80(void);
void seeded_80(void) {
  char *memory = malloc(4u);
  if (memory != NULL) {
    memory[0] = 'a';
  }
} /* seed: -Wanalyzer-malloc-leak */
