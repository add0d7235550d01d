/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

extern volatile int32_t seeded_port;

extern int32_t seeded_30(int32_t a, int32_t b);
int32_t seeded_30(int32_t a, int32_t b) {
  int32_t n = a;
  const int32_t list[2] = {n++, b}; /* seed: 13.1 */
  int32_t r1 = n++ + b; /* seed: 13.3 */
  int32_t r2 = (n = b); /* seed: 13.4 */
  return n;
}

extern void seeded_31(int32_t a, int32_t *where);
void seeded_31(int32_t a, int32_t *where) {
  int32_t i = 0;
  for (float f = 0.0F; f < 1.0F; f += 0.1F) { /* seed: 14.1 */
    *where = a;
  }
  for (i = 0; i < a; i++) { /* counts itself twice */
    i++; /* seed: 14.2 */
  }
  while (a) { /* seed: 14.4 */
    *where = a;
  }
}

extern int32_t seeded_32(int32_t a);
int32_t seeded_32(int32_t a) {
  int32_t n = a;
  while (n < 9) { /* seed: 15.4 */
    n++;
    if (n == 4) {
      break;
    }
    if (n == 5) {
      break;
    }
  }
  if (n == 3) {
    return 2; /* seed: 15.5 */
  }
  if (n == 2) /* seed: 15.6 */
    n++;
  if (n == 1) {
    n++;
  } else if (n == 0) {
    n--;
  } /* seed: 15.7 */
  return n;
}

extern int32_t seeded_33(int32_t a, bool truth);
int32_t seeded_33(int32_t a, bool truth) {
  int32_t n = a;
  switch (a) {
    n++; /* seed: 16.1 */
    case 1:
      n++;
      break;
    default:
      break;
  }
  switch (a) {
    case 1:
      if (n > 1) {
        case 2: /* seed: 16.2 */
          n++;
      }
      break;
    default:
      break;
  }
  switch (a) {
    case 1:
      n++;
    case 2: /* seed: 16.3 */
      n--;
      break;
    default:
      break;
  }
  switch (a) { /* seed: 16.4 */
    case 1:
      n--;
      break;
    case 2:
      n++;
      break;
  }
  switch (a) {
    case 1:
      n--;
      break;
    default: /* seed: 16.5 */
      break;
    case 2:
      n++;
      break;
  }
  switch (a) { /* seed: 16.6 */
    default:
      n++;
      break;
  }
  switch (truth) { /* seed: 16.7 */
    case 1:
      n++;
      break;
    default:
      break;
  }
  return n;
}
