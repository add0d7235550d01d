#include "plant/robot_file.hpp"

#include <array>
#include <boost/crc.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

namespace interlock::plant {
namespace {

constexpr std::int32_t kFarthestCounts = 1 << 30;

using Bytes = std::array<unsigned char, sizeof(ilk_config_t)>;

std::uint32_t crc_of(const Bytes& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size() - sizeof(std::uint32_t));
  return crc.checksum();
}

ilk_config_t from_little_endian(const Bytes& bytes) {
  std::array<std::uint32_t, sizeof(ilk_config_t) / sizeof(std::uint32_t)> words{};
  for (std::size_t word = 0; word < words.size(); ++word) {
    for (std::size_t byte = 0; byte < sizeof(std::uint32_t); ++byte) {
      words[word] |= static_cast<std::uint32_t>(bytes[word * sizeof(std::uint32_t) + byte]) << (8 * byte);
    }
  }
  ilk_config_t config;
  std::memcpy(&config, words.data(), sizeof config);
  return config;
}

std::optional<std::string> fault_of_axis(const ilk_axis_config_t& axis) {
  if (axis.card > ILK_CARD_SENSOR) {
    return "card type " + std::to_string(axis.card) + " is unknown";
  }
  const bool motor = axis.card != ILK_CARD_NONE && axis.card != ILK_CARD_SENSOR;
  if (!motor) {
    return std::nullopt;
  }
  if (axis.limit_side > ILK_LIMIT_UPPER) {
    return "limit side " + std::to_string(axis.limit_side) + " is unknown";
  }
  if (axis.min_counts >= axis.max_counts || axis.min_counts < -kFarthestCounts ||
      axis.max_counts > kFarthestCounts) {
    return "soft limits " + std::to_string(axis.min_counts) + " to " + std::to_string(axis.max_counts) +
           " are no range within +-2^30 counts";
  }
  if (axis.home_offset_counts < -kFarthestCounts || axis.home_offset_counts > kFarthestCounts) {
    return "home offset " + std::to_string(axis.home_offset_counts) + " is beyond 2^30 counts";
  }
  if (axis.max_drive == 0) {
    return std::string("max_drive is 0");
  }
  if (axis.card == ILK_CARD_HIGH_FREQUENCY && axis.max_amplitude == 0) {
    return std::string("max_amplitude is 0 on a high-frequency card");
  }
  return std::nullopt;
}

std::optional<std::string> fault_of(const ilk_config_t& config) {
  if (config.common.period_us < 125 || config.common.period_us > 2000) {
    return "period " + std::to_string(config.common.period_us) + " us, expected 125 to 2000";
  }
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (const auto fault = fault_of_axis(config.axis[slot])) {
      return "slot " + std::to_string(slot) + ": " + *fault;
    }
  }
  return std::nullopt;
}

}  // namespace

tl::expected<ilk_config_t, std::string> load_robot(const std::filesystem::path& path) {
  const auto refuse = [&path](const std::string& what) {
    return tl::unexpected(path.string() + ": " + what +
                          "; compile the robot file again with 'interlock model compile'");
  };
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return tl::unexpected(path.string() + ": cannot be read; expected a compiled robot file (*.ilkc)");
  }
  Bytes bytes{};
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file || file.peek() != std::ifstream::traits_type::eof()) {
    return refuse("is no configuration of " + std::to_string(bytes.size()) + " bytes");
  }
  const ilk_config_t config = from_little_endian(bytes);
  if (config.common.version != ILK_CONFIG_VERSION || config.common.size_bytes != sizeof(ilk_config_t)) {
    return refuse("has version " + std::to_string(config.common.version) + " and size " +
                  std::to_string(config.common.size_bytes) + ", expected " +
                  std::to_string(ILK_CONFIG_VERSION) + " and " + std::to_string(sizeof(ilk_config_t)));
  }
  if (config.crc != crc_of(bytes)) {
    return refuse("is damaged: its CRC does not match");
  }
  if (const auto fault = fault_of(config)) {
    return refuse(*fault);
  }
  return config;
}

}  // namespace interlock::plant
