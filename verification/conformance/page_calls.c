#include "page_calls.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/uio.h>
#include <unistd.h>

enum { TO_PAGE = 3, FROM_PAGE = 4, ARGUMENTS = 4 };

/** One call: its number, the length of each argument, then the arguments. Gives the answer's word. */
static uint32_t call_page(uint32_t function, const void* const arguments[ARGUMENTS],
                          const uint32_t bytes[ARGUMENTS]) {
  struct iovec parts[2 + ARGUMENTS] = {{&function, sizeof function},
                                       {(void*)bytes, ARGUMENTS * sizeof bytes[0]}};
  ssize_t length = (ssize_t)(parts[0].iov_len + parts[1].iov_len);
  for (int i = 0; i < ARGUMENTS; ++i) {
    parts[2 + i] = (struct iovec){(void*)arguments[i], bytes[i]};
    length += (ssize_t)bytes[i];
  }
  uint32_t answer = 0;
  if (writev(TO_PAGE, parts, 2 + ARGUMENTS) != length ||
      read(FROM_PAGE, &answer, sizeof answer) != (ssize_t)sizeof answer) {
    (void)fputs("the kernel in the page gives no answer\n", stderr);
    exit(2);
  }
  return answer;
}

uint32_t page_request_judge(const ilk_config_t* config, const ilk_state_t* state,
                            const ilk_request_t* request) {
  const void* const arguments[ARGUMENTS] = {config, state, request};
  const uint32_t bytes[ARGUMENTS] = {sizeof *config, sizeof *state, sizeof *request};
  return call_page(0, arguments, bytes);
}

uint32_t page_output_gate(const ilk_axis_config_t* config, const ilk_state_t* state, const ilk_axis_t* axis,
                          const ilk_command_t* wanted) {
  const void* const arguments[ARGUMENTS] = {config, state, axis, wanted};
  const uint32_t bytes[ARGUMENTS] = {sizeof *config, sizeof *state, sizeof *axis, sizeof *wanted};
  return call_page(1, arguments, bytes);
}
