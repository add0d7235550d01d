/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

extern void *seeded_63(void);
void *seeded_63(void) {
  void *memory = malloc(4U); /* seed: 21.3 */
  (void)system("true"); /* seed: 21.21 */
  return memory;
}

inline uint32_t seeded_64(void); /* seed: 8.10 */
inline uint32_t seeded_64(void) {
  return 1U;
}

extern double seeded_65(const char *text);
double seeded_65(const char *text) {
  return strtod(text, NULL); /* seed: 22.8 */
}

extern double seeded_66(const char *text);
double seeded_66(const char *text) {
  errno = 0;
  const double number = strtod(text, NULL); /* seed: 22.9 */
  return number;
}

extern int32_t seeded_67(void);
int32_t seeded_67(void) {
  int32_t n = 0;
  seeded_61(1U);
  if (errno != 0) { /* seed: 22.10 */
    n = 1;
  }
  return n;
}

extern int32_t seeded_68(FILE *file);
int32_t seeded_68(FILE *file) {
  int32_t n = 0;
  const char c = (char)getc(file);
  if (c == EOF) { /* seed: 22.7 */
    n = 1;
  }
  return n;
}
