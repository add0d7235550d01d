/* Seeded violations: never compiled. Each line that ends in a seed comment must be found. */
#include <stdbool.h>
#include <stdint.h>

int32_t an_external_name_of_many_characters_that_go_on_beyond_the_limit_a;
int32_t an_external_name_of_many_characters_that_go_on_beyond_the_limit_b; /* seed: 5.1 */

extern int32_t seeded_05(int32_t value);
int32_t seeded_05(int32_t value) {
  int32_t a_local_name_of_many_characters_that_go_on_beyond_the_limit_of_63_a = value;
  int32_t a_local_name_of_many_characters_that_go_on_beyond_the_limit_of_63_b = value; /* seed: 5.2 */
  int32_t hidden = value;
  if (hidden > 1) {
    int32_t hidden = 2;
    a_local_name_of_many_characters_that_go_on_beyond_the_limit_of_63_a += hidden;
  }
  return a_local_name_of_many_characters_that_go_on_beyond_the_limit_of_63_a +
         a_local_name_of_many_characters_that_go_on_beyond_the_limit_of_63_b;
}

#define A_MACRO_NAME_OF_MANY_CHARACTERS_THAT_GO_ON_BEYOND_THE_LIMIT_OF_63_A 1
#define A_MACRO_NAME_OF_MANY_CHARACTERS_THAT_GO_ON_BEYOND_THE_LIMIT_OF_63_B 2 /* seed: 5.4 */

#define seeded_macro(x) (x)
static int32_t seeded_macro; /* seed: 5.5 */


struct tagged {
  int32_t member;
};
static void seeded_07(void) {
  struct tagged { /* seed: 5.7 */
    int32_t member;
  } local;
}

int32_t seeded_external;
static void seeded_twice(void) {
  seeded_external = 1;
}

typedef struct {
  int8_t bits : 2; /* seed: 6.1 */
} bits_t;

typedef struct {
  signed int bit : 1; /* seed: 6.2 */
} bit_t;

static const int32_t octal = 017; /* seed: 7.1 */
static const uint32_t suffixless = 0x80000000; /* seed: 7.2 */
static const int64_t lower = 1l; /* seed: 7.3 */
static char *text = "text"; /* seed: 7.4 */


static int32_t seeded_11(int32_t); /* seed: 8.2 */

int32_t seeded_12(void) { /* seed: 8.4 */
  return 1;
}

extern int32_t seeded_once;
extern int32_t seeded_once; /* seed: 8.5 */


extern int32_t seeded_only_here(void);
int32_t seeded_only_here(void) { /* seed: 8.7 */
  return 1;
}
static void seeded_user(void) {
  (void)seeded_only_here();
}

static int32_t seeded_13;
extern int32_t seeded_13; /* seed: 8.8 */

static int32_t seeded_in_one_function = 1; /* seed: 8.9 */
extern int32_t seeded_14(void);
int32_t seeded_14(void) {
  return seeded_in_one_function;
}


extern int32_t seeded_array[]; /* seed: 8.11 */

typedef enum { SEEDED_A = 1, SEEDED_B, SEEDED_C = 2 } seeded_enum_t; /* seed: 8.12 */

static void seeded_16(int32_t *restrict where) { /* seed: 8.14 */
  *where = 1;
}
