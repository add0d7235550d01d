/* Seeded violations for clang-tidy: each line that ends in a seed comment must be found. */
#include <stdint.h>

int32_t BadName; /* seed: readability-identifier-naming */
int32_t seeded_90(int32_t value); /* seed: readability-inconsistent-declaration-parameter-name */
int32_t seeded_90(int32_t amount) { return amount; }

int32_t seeded_91(int32_t *only_read);
int32_t seeded_91(int32_t *only_read) { return *only_read; } /* seed: readability-non-const-parameter */

int32_t seeded_92(int32_t value);
int32_t seeded_92(int32_t value) {
  switch (value) { /* seed: bugprone-switch-missing-default-case */
    case 1:
      return 2;
  }
  return 1;
}
