/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
  int32_t a;
  int32_t b[2];
} pair_t;

static const int32_t flat[2][2] = {1, 2, 3, 4}; /* seed: 9.2 */
static const int32_t partial[3] = {1, 2}; /* seed: 9.3 */
static const int32_t again[2] = {[0] = 1, [0] = 2}; /* seed: 9.4 */
static const int32_t unsized[] = {[0] = 1}; /* seed: 9.5 */

typedef enum { LEFT, RIGHT } side_t;

extern void seeded_20(uint8_t small, uint16_t middle, uint32_t wide, int32_t number, bool truth, char letter);
void seeded_20(uint8_t small, uint16_t middle, uint32_t wide, int32_t number, bool truth, char letter) {
  uint32_t r1 = wide << truth; /* seed: 10.1 */
  char r2 = 'a' + 'b'; /* seed: 10.2 */
  uint8_t r3 = wide; /* seed: 10.3 */
  uint32_t r4 = wide + number; /* seed: 10.4 */
  side_t r5 = (side_t)truth; /* seed: 10.5 */
  uint32_t r6 = middle + middle; /* seed: 10.6 */
  uint32_t r7 = wide * (middle + middle); /* seed: 10.7 */
  uint32_t r8 = (uint32_t)(middle + middle); /* seed: 10.8 */
}

struct unknown;
extern void seeded_21(int32_t *where, void *any, const int32_t *fixed, double real);
void seeded_21(int32_t *where, void *any, const int32_t *fixed, double real) {
  struct unknown *hidden = (struct unknown *)where; /* seed: 11.2 */
  int16_t *narrow = (int16_t *)where; /* seed: 11.3 */
  uint32_t address = (uint32_t)where; /* seed: 11.4 */
  int32_t *from_any = any; /* seed: 11.5 */
  uint32_t word = (uint32_t)any; /* seed: 11.6 */
  int32_t *from_real = (int32_t *)real; /* seed: 11.7 */
  int32_t *writable = (int32_t *)fixed; /* seed: 11.8 */
  int32_t *nothing = 0; /* seed: 11.9 */
}

extern int32_t seeded_22(int32_t a, int32_t b, int32_t c);
int32_t seeded_22(int32_t a, int32_t b, int32_t c) {
  int32_t r1 = a + b * c; /* seed: 12.1 */
  uint32_t r2 = 1U << 33U; /* seed: 12.2 */
  int32_t r3 = a, r5 = b; /* seed: 12.3 */
  uint32_t r4 = 0U - 1U; /* seed: 12.4 */
  return r1;
}
