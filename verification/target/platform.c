#include "platform.h"

void say_number(uint32_t number) {
  char text[12] = {0};
  uint32_t at = 11u;
  uint32_t rest = number;
  do {
    at--;
    text[at] = (char)('0' + (char)(rest % 10u));
    rest /= 10u;
  } while (rest != 0u);
  say(&text[at]);
}

void say_hex(uint32_t word) {
  static const char digits[] = "0123456789abcdef";
  char text[9] = {0};
  for (uint32_t digit = 0u; digit < 8u; digit++) {
    text[digit] = digits[(word >> (28u - (4u * digit))) & 15u];
  }
  say(text);
}
