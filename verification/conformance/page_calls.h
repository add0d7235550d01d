/**
 * @file
 * The kernel's functions as the kernel in the console's page computes them: each call goes over a pipe to
 * page_kernel.mjs, which makes it in WebAssembly.
 */
#ifndef ILK_PAGE_CALLS_H
#define ILK_PAGE_CALLS_H

#include "interlock/types.h"

uint32_t page_request_judge(const ilk_config_t* config, const ilk_state_t* state,
                            const ilk_request_t* request);
uint32_t page_output_gate(const ilk_axis_config_t* config, const ilk_state_t* state, const ilk_axis_t* axis,
                          const ilk_command_t* wanted);

#endif
