/**
 * @file
 * What a test image asks of the machine under it: to say something, and to end.
 */
#ifndef ILK_TARGET_PLATFORM_H
#define ILK_TARGET_PLATFORM_H

#include <stdint.h>

void say(const char *text);
void say_number(uint32_t number);
void say_hex(uint32_t word);

/** The whole program. Returns the number of mismatches. */
uint32_t run_image(void);

#endif
