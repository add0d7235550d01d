/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <stdint.h>

_Noreturn void forever(void); /* seed: 1.4 */

extern int32_t seeded_01(int32_t value);

int32_t seeded_01(int32_t value) {
  int32_t result = value;
  goto done; /* seed: 15.1 */
  result++;
done:
  return result;
}

typedef int32_t unused_type_t; /* seed: 2.3 */

struct unused_tag { /* seed: 2.4 */
  int32_t member;
};

#define UNUSED_MACRO 1 /* seed: 2.5 */

extern int32_t seeded_02(int32_t unused); /* names its parameter */
int32_t seeded_02(int32_t unused) { /* seed: 2.7 */
  return 1;
}

/* a comment /* within a comment seed: 3.1 */
// a line comment that goes on (seed: 3.2) \
   to the next line

extern const char *seeded_03(void);
const char *seeded_03(void) {
  return "\x41g"; /* seed: 4.1 */
}

extern const char *seeded_04(void);
const char *seeded_04(void) {
  return "what ??= is this"; /* seed: 4.2 */
}
