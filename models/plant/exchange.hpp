/** @file A plant and a kernel core in one process. */
#pragma once

#include <cstdint>

#include "interlock/types.h"
#include "plant/plant.hpp"

namespace interlock::plant {

/**
 * One exchange of the plant with what the kernel put out in its last tick, and one period of physics: the
 * inputs of the kernel's tick `kernel_tick`, as the executive would gather them over the bus.
 */
ilk_inputs_t exchange(Plant& plant, const ilk_outputs_t& outputs, std::uint32_t kernel_tick);

}  // namespace interlock::plant
