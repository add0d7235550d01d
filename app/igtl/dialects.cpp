#include <string_view>

#include "igtl/thesis.hpp"
#include "igtl/workphases.hpp"

namespace interlock::igtl {

std::unique_ptr<Dialect> make_dialect(std::string_view name) {
  if (name == "thesis") {
    return std::make_unique<Thesis>();
  }
  if (name == "brp2013") {
    return std::make_unique<Brp2013>();
  }
  if (name == "wpi2024") {
    return std::make_unique<Wpi2024>();
  }
  return nullptr;
}

}  // namespace interlock::igtl
