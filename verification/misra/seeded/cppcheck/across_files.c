/* Seeded violations: never compiled. What two files may not both do: the other half is in section_05_08.c. */
#include <stdint.h>

static int32_t seeded_external; /* seed: 5.8 */

static void seeded_twice(void) { /* seed: 5.9 */
}
