#include "plant/exchange.hpp"

#include <algorithm>

namespace interlock::plant {

ilk_inputs_t exchange(Plant& plant, const ilk_outputs_t& outputs, std::uint32_t kernel_tick) {
  constexpr std::size_t words = std::size_t{ILK_SLOTS} * ILK_FRAME_WORDS;
  ilk_sim_exchange_t sent{};
  sent.magic = ILK_SIM_MAGIC;
  sent.tick = kernel_tick;
  sent.power = outputs.power;
  std::copy_n(&outputs.frame[0][0], words, &sent.frame[0][0]);
  const ilk_sim_reply_t reply = plant.tick(sent);
  ilk_inputs_t inputs{};
  inputs.link_generation = 1;
  inputs.boot_nonce = 1;
  inputs.transaction_done = 1;
  inputs.frames_received = reply.frames_received;
  inputs.pedal_no_closed = reply.pedal_no_closed;
  inputs.pedal_nc_closed = reply.pedal_nc_closed;
  inputs.estop_loop_closed = reply.estop_loop_closed;
  std::copy_n(&reply.frame[0][0], words, &inputs.frame[0][0]);
  return inputs;
}

}  // namespace interlock::plant
