#include <stdio.h>

#include "platform.h"

void say(const char *text) { (void)fputs(text, stdout); }

int main(void) { return (run_image() == 0u) ? 0 : 1; }
