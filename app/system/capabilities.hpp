/**
 * @file
 * What the system lets the app do beyond what any program may: nothing.
 */
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace interlock {

/**
 * Gives up every capability, and the way to any by starting a program, for this process and all its later
 * threads. The app needs none; without them it cannot open a device, take a real-time priority or look into
 * another user's process even when root starts it. To be called before there is a second thread.
 *
 * @return the reason when the system refuses.
 */
tl::expected<void, std::string> give_up_capabilities();

}  // namespace interlock
