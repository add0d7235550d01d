/**
 * @file
 * A Cortex-M without a library's start-up: vector table, reset, and semihosting to speak through the
 * debugger.
 */
#include "platform.h"

#define SYS_WRITE0 0x04u
#define SYS_EXIT 0x18u
#define EXIT_SOUND 0x20026u
#define EXIT_FAULT 0x20023u

extern uint32_t image_stack_top[];
extern uint32_t image_data_load[];
extern uint32_t image_data_start[];
extern uint32_t image_data_end[];
extern uint32_t image_bss_start[];
extern uint32_t image_bss_end[];

static void ask_host(uint32_t operation, uint32_t argument) {
  register uint32_t r0 __asm__("r0") = operation;
  register uint32_t r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void say(const char *text) { ask_host(SYS_WRITE0, (uint32_t)text); }

static void reset(void) {
  const uint32_t *from = image_data_load;
  for (uint32_t *to = image_data_start; to < image_data_end; to++) {
    *to = *from;
    from++;
  }
  for (uint32_t *to = image_bss_start; to < image_bss_end; to++) {
    *to = 0u;
  }
  ask_host(SYS_EXIT, (run_image() == 0u) ? EXIT_SOUND : EXIT_FAULT);
}

static void fault(void) {
  say("fault: the processor took an exception\n");
  ask_host(SYS_EXIT, EXIT_FAULT);
}

typedef void (*handler_t)(void);

__attribute__((section(".vectors"), used)) static const struct {
  uint32_t *stack;
  handler_t handler[15];
} vectors = {image_stack_top, {reset, fault, fault, fault, fault, fault}};
