#include "bus_spi.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/gpio.h>
#include <linux/spi/spidev.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fixtures.hpp"
#include "interlock/kernel.h"

namespace {

using interlock::host_test::TemporaryDirectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The linker puts __wrap_... in place of the system's calls (-Wl,--wrap).
extern "C" int __real_ioctl(int descriptor, unsigned long request, void* argument);
extern "C" int __real_open(const char* path, int flags, mode_t mode);

constexpr std::uint32_t power_line = 23;

using Bytes = std::array<std::uint8_t, ILK_FRAME_BYTES>;

/// A card behind a chip select: keeps what it was sent, answers what the test put there.
struct FakeCard {
  std::uint32_t mode = 99;
  std::uint8_t bits = 0;
  std::uint32_t max_speed_hz = 0;
  int transfers = 0;
  std::optional<int> refusal;  /// `errno` of each transfer
  std::size_t bytes_short = 0;
  Bytes heard{};
  Bytes answer{};
};

/// A machine of fake devices behind `open` and `ioctl`, with descriptors that are real ones.
class FakeMachine {
 public:
  FakeMachine() { current = this; }
  ~FakeMachine() {
    current = nullptr;
    for (const auto& [path, device] : device_of_) {
      close(device);
    }
  }

  static FakeMachine* current;

  std::map<std::string, FakeCard> cards;
  std::uint64_t contacts_closed = 0;   /// bit by place in the request, as the kernel of Linux tells it
  std::optional<int> refused_request;  /// ioctl that fails with EBUSY
  std::optional<int> contacts_refusal;
  gpio_v2_line_request inputs{};
  gpio_v2_line_request outputs{};
  gpio_v2_line_request power{};
  std::optional<int> power_refusal;
  std::vector<std::uint64_t> power_levels;  ///< as they were set
  std::uint64_t lights = 0;
  std::vector<std::uint64_t> light_masks;

  std::optional<int> open_device(const std::string& path) {
    if (path != "/dev/gpiochip7" && !cards.contains(path)) {
      return std::nullopt;
    }
    if (!device_of_.contains(path)) {
      device_of_[path] = memfd_create("device", MFD_CLOEXEC);
    }
    // Each opening for itself, so that a lock of one keeps the other out.
    const std::string again = "/proc/self/fd/" + std::to_string(device_of_[path]);
    const int descriptor = __real_open(again.c_str(), O_RDWR | O_CLOEXEC, 0);
    path_of_[descriptor] = path;
    return descriptor;
  }

  std::optional<int> call(int descriptor, unsigned long request, void* argument) {
    if (refused_request && static_cast<int>(request) == *refused_request) {
      return refuse(EBUSY);
    }
    if (descriptor == inputs.fd && request == GPIO_V2_LINE_GET_VALUES_IOCTL) {
      return read_contacts(*static_cast<gpio_v2_line_values*>(argument));
    }
    if (descriptor == power.fd && request == GPIO_V2_LINE_SET_VALUES_IOCTL) {
      return set_power(*static_cast<gpio_v2_line_values*>(argument));
    }
    if (descriptor == outputs.fd && request == GPIO_V2_LINE_SET_VALUES_IOCTL) {
      const auto& values = *static_cast<gpio_v2_line_values*>(argument);
      lights = (lights & ~values.mask) | (values.bits & values.mask);
      light_masks.push_back(values.mask);
      return 0;
    }
    const auto path = path_of_.find(descriptor);
    if (path == path_of_.end()) {
      return std::nullopt;
    }
    return request == GPIO_V2_GET_LINE_IOCTL ? give_lines(*static_cast<gpio_v2_line_request*>(argument))
                                             : call_card(cards.at(path->second), request, argument);
  }

 private:
  static int refuse(int reason) {
    errno = reason;
    return -1;
  }

  int read_contacts(gpio_v2_line_values& values) const {
    if (contacts_refusal) {
      return refuse(*contacts_refusal);
    }
    values.bits = contacts_closed & values.mask;
    return 0;
  }

  int set_power(const gpio_v2_line_values& values) {
    if (power_refusal) {
      return refuse(*power_refusal);
    }
    power_levels.push_back(values.bits & values.mask);
    return 0;
  }

  int give_lines(gpio_v2_line_request& request) {
    request.fd = memfd_create("lines", MFD_CLOEXEC);
    gpio_v2_line_request& given = request.offsets[0] == power_line ? power : outputs;
    ((request.config.flags & GPIO_V2_LINE_FLAG_INPUT) != 0 ? inputs : given) = request;
    return 0;
  }

  static int call_card(FakeCard& card, unsigned long request, void* argument) {
    switch (request) {
      case SPI_IOC_WR_MODE32:
        card.mode = *static_cast<std::uint32_t*>(argument);
        return 0;
      case SPI_IOC_WR_BITS_PER_WORD:
        card.bits = *static_cast<std::uint8_t*>(argument);
        return 0;
      case SPI_IOC_WR_MAX_SPEED_HZ:
        card.max_speed_hz = *static_cast<std::uint32_t*>(argument);
        return 0;
      case SPI_IOC_MESSAGE(1):
        return transfer(card, *static_cast<spi_ioc_transfer*>(argument));
      default:
        return refuse(ENOTTY);
    }
  }

  static int transfer(FakeCard& card, const spi_ioc_transfer& wanted) {
    card.transfers += 1;
    if (card.refusal) {
      return refuse(*card.refusal);
    }
    EXPECT_EQ(wanted.len, ILK_FRAME_BYTES);
    EXPECT_EQ(wanted.speed_hz, card.max_speed_hz);
    EXPECT_EQ(wanted.cs_change, 0);
    std::memcpy(card.heard.data(), reinterpret_cast<const void*>(wanted.tx_buf), card.heard.size());
    std::memcpy(reinterpret_cast<void*>(wanted.rx_buf), card.answer.data(), card.answer.size());
    return static_cast<int>(wanted.len - card.bytes_short);
  }

  std::map<std::string, int> device_of_;
  std::map<int, std::string> path_of_;
};

FakeMachine* FakeMachine::current = nullptr;

}  // namespace

extern "C" {
int __wrap_ioctl(int descriptor, unsigned long request, void* argument);
int __wrap_open(const char* path, int flags, mode_t mode);

int __wrap_ioctl(int descriptor, unsigned long request, void* argument) {
  const auto answer = FakeMachine::current != nullptr
                          ? FakeMachine::current->call(descriptor, request, argument)
                          : std::nullopt;
  return answer ? *answer : __real_ioctl(descriptor, request, argument);
}

int __wrap_open(const char* path, int flags, mode_t mode) {
  const auto opened =
      FakeMachine::current != nullptr ? FakeMachine::current->open_device(path) : std::nullopt;
  return opened ? *opened : __real_open(path, flags, mode);
}
}

namespace {

constexpr const char* first_card = "/dev/spidev7.0";
constexpr const char* third_card = "/dev/spidev7.2";

/// Cards in slots 0 and 2, a pedal of two channels, power, all lamps.
ilk_spi_wiring_t wiring() {
  ilk_spi_wiring_t wired{};
  std::strcpy(wired.card[0], first_card);
  std::strcpy(wired.card[2], third_card);
  std::strcpy(wired.gpio, "/dev/gpiochip7");
  wired.speed_hz = 20'000'000;
  wired.contact[ILK_CONTACT_PEDAL_NO] = {17, true};
  wired.contact[ILK_CONTACT_PEDAL_NC] = {27, true};
  wired.contact[ILK_CONTACT_ESTOP] = {22, false};
  wired.power = {power_line, false};
  std::uint32_t next = 30;
  for (auto& lamp : wired.lamp) {
    for (auto& line : lamp) {
      line = {next++, false};
    }
  }
  return wired;
}

class BusSpi : public ::testing::Test {
 protected:
  BusSpi() {
    machine.cards[first_card];
    machine.cards[third_card];
  }
  ~BusSpi() override {
    if (opened_) {
      ilk_bus_spi_close(&spi_);
    }
  }

  bool open(const ilk_spi_wiring_t& wired) {
    opened_ = ilk_bus_spi_open(&spi_, &wired, &error);
    bus_ = ilk_bus_spi_driver(&spi_);
    return opened_;
  }

  bool transact() { return bus_.transact(bus_.driver, 5, &out, &in); }

  FakeMachine machine;
  ilk_outputs_t out{};
  ilk_inputs_t in{};
  ilk_error_t error{};
  ilk_bus_t bus_{};

 private:
  ilk_bus_spi_t spi_{};
  bool opened_ = false;
};

TEST_F(BusSpi, IsHardwareSetUpInModeZeroWithTheWiredClock) {
  ASSERT_TRUE(open(wiring())) << error.text;
  EXPECT_FALSE(bus_.simulated);
  for (const auto& [path, card] : machine.cards) {
    EXPECT_EQ(card.mode, SPI_MODE_0) << path;
    EXPECT_EQ(card.bits, 8) << path;
    EXPECT_EQ(card.max_speed_hz, 20'000'000u) << path;
    EXPECT_EQ(card.transfers, 0) << "nothing is sent before the loop runs";
  }
}

TEST_F(BusSpi, ExchangesEachCardsFrameHighestByteFirst) {
  ASSERT_TRUE(open(wiring())) << error.text;
  out.frame[0][0] = 0xFEFEFE01u;
  out.frame[2][ILK_FRAME_WORDS - 1] = 0x01020304u;
  machine.cards[third_card].answer[0] = 0xAB;
  machine.cards[third_card].answer[3] = 0xCD;
  machine.cards[first_card].answer[ILK_FRAME_BYTES - 1] = 0x7E;
  ASSERT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 1u);
  EXPECT_EQ(in.frames_received, 0b101u);
  EXPECT_EQ(machine.cards[first_card].heard[0], 0xFE);
  EXPECT_EQ(machine.cards[first_card].heard[3], 0x01);
  EXPECT_EQ(machine.cards[third_card].heard[ILK_FRAME_BYTES - 4], 0x01);
  EXPECT_EQ(machine.cards[third_card].heard[ILK_FRAME_BYTES - 1], 0x04);
  EXPECT_EQ(in.frame[2][0], 0xAB0000CDu);
  EXPECT_EQ(in.frame[0][ILK_FRAME_WORDS - 1], 0x7Eu);
}

TEST_F(BusSpi, ACardThatDoesNotAnswerIsNotReceivedAndTheOthersAre) {
  ASSERT_TRUE(open(wiring())) << error.text;
  machine.cards[first_card].refusal = ETIMEDOUT;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 1u);
  EXPECT_EQ(in.frames_received, 0b100u);
  machine.cards[first_card].refusal.reset();
  machine.cards[first_card].bytes_short = 1;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.frames_received, 0b100u);
  machine.cards[first_card].bytes_short = 0;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.frames_received, 0b101u);
}

TEST_F(BusSpi, WithoutAnyCardTheTransactionFailed) {
  ASSERT_TRUE(open(wiring())) << error.text;
  machine.cards[first_card].refusal = EIO;
  machine.cards[third_card].refusal = EIO;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 0u);
  EXPECT_EQ(in.frames_received, 0u);
}

TEST_F(BusSpi, ContactsAreReadByTheirPlace) {
  ASSERT_TRUE(open(wiring())) << error.text;
  const auto read = [&](std::uint64_t closed) {
    machine.contacts_closed = closed;
    transact();
    return std::array{in.pedal_no_closed, in.pedal_nc_closed, in.estop_loop_closed};
  };
  EXPECT_THAT(read(0b001), ElementsAre(1u, 0u, 0u));
  EXPECT_THAT(read(0b010), ElementsAre(0u, 1u, 0u));
  EXPECT_THAT(read(0b100), ElementsAre(0u, 0u, 1u));
}

TEST_F(BusSpi, TheLoopOfAPedalWithOneChannelIsTheSecondLine) {
  ilk_spi_wiring_t one_channel = wiring();
  one_channel.contact[ILK_CONTACT_PEDAL_NC].offset = ILK_NO_LINE;
  ASSERT_TRUE(open(one_channel)) << error.text;
  machine.contacts_closed = 0b10;
  transact();
  EXPECT_EQ(in.pedal_no_closed, 0u);
  EXPECT_EQ(in.pedal_nc_closed, 0u);
  EXPECT_EQ(in.estop_loop_closed, 1u);
}

TEST_F(BusSpi, ABrokenWireReadsAsAnOpenContact) {
  ASSERT_TRUE(open(wiring())) << error.text;
  ASSERT_EQ(machine.inputs.num_lines, 3u);
  EXPECT_EQ(machine.inputs.offsets[0], 17u);
  EXPECT_EQ(machine.inputs.offsets[1], 27u);
  EXPECT_EQ(machine.inputs.offsets[2], 22u);
  EXPECT_EQ(machine.inputs.config.flags, GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN);
  ASSERT_EQ(machine.inputs.config.num_attrs, 1u);
  EXPECT_EQ(machine.inputs.config.attrs[0].mask, 0b011u);
  EXPECT_EQ(machine.inputs.config.attrs[0].attr.id, static_cast<std::uint32_t>(GPIO_V2_LINE_ATTR_ID_FLAGS));
  EXPECT_EQ(machine.inputs.config.attrs[0].attr.flags,
            GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_BIAS_PULL_UP | GPIO_V2_LINE_FLAG_ACTIVE_LOW);
}

TEST_F(BusSpi, P2_ContactsThatCannotBeReadFailTheTransactionWhateverTheCardsSay) {
  ASSERT_TRUE(open(wiring())) << error.text;
  machine.contacts_closed = 0b101;
  transact();
  machine.contacts_refusal = ENODEV;
  machine.contacts_closed = 0b010;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 0u);
  EXPECT_EQ(in.frames_received, 0u);
  EXPECT_EQ(in.pedal_no_closed, 1u) << "the contacts keep what was last read";
}

TEST_F(BusSpi, LampsAreSetWhenTheyChangeInTheirColours) {
  ASSERT_TRUE(open(wiring())) << error.text;
  transact();
  EXPECT_TRUE(machine.light_masks.empty()) << "dark they are already";
  out.lamp[ILK_LAMP_PEDAL] = ILK_COLOUR_GREEN;
  out.lamp[ILK_LAMP_NETWORK] = ILK_COLOUR_RED;
  out.lamp[ILK_LAMP_CONTROLLER] = ILK_COLOUR_AMBER;
  out.lamp[ILK_LAMP_STALL] = ILK_COLOUR_PURPLE;
  transact();
  EXPECT_EQ(machine.lights, 0b101'011'001'010u);
  transact();
  EXPECT_EQ(machine.light_masks.size(), 1u);
  out.lamp[ILK_LAMP_STALL] = 77;
  transact();
  EXPECT_EQ(machine.lights, 0b000'011'001'010u) << "an unknown colour is dark";
}

TEST_F(BusSpi, PowerFollowsTheKernelAndIsOffAtFirst) {
  ASSERT_TRUE(open(wiring())) << error.text;
  EXPECT_EQ(machine.power.num_lines, 1u);
  EXPECT_EQ(machine.power.config.flags, std::uint64_t{GPIO_V2_LINE_FLAG_OUTPUT});
  EXPECT_EQ(machine.power.config.num_attrs, 0u) << "no value is given with the request: the line is off";
  for (const std::uint32_t power : {0u, 1u, 1u, 2u, 0u}) {
    out.power = power;
    EXPECT_TRUE(transact());
    EXPECT_EQ(in.transaction_done, 1u);
  }
  EXPECT_THAT(machine.power_levels, ElementsAre(0u, 1u, 1u, 0u, 0u)) << "set in each tick, on by 1 alone";
}

TEST_F(BusSpi, PowerThatIsOnWhileItsLineIsLowIsWiredSo) {
  ilk_spi_wiring_t low = wiring();
  low.power.active_low = true;
  ASSERT_TRUE(open(low)) << error.text;
  EXPECT_NE(machine.power.config.flags & GPIO_V2_LINE_FLAG_ACTIVE_LOW, 0u);
}

TEST_F(BusSpi, ATickInWhichPowerCannotBeSetIsAFailedTransaction) {
  ASSERT_TRUE(open(wiring())) << error.text;
  machine.power_refusal = EIO;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 0u);
  EXPECT_EQ(in.frames_received, 0u);
  machine.power_refusal.reset();
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 1u);
}

TEST_F(BusSpi, AMachineWithoutLampsNeedsNoOutputs) {
  ilk_spi_wiring_t dark = wiring();
  for (auto& lamp : dark.lamp) {
    for (auto& line : lamp) {
      line.offset = ILK_NO_LINE;
    }
  }
  ASSERT_TRUE(open(dark)) << error.text;
  EXPECT_EQ(machine.outputs.num_lines, 0u);
  out.lamp[ILK_LAMP_PEDAL] = ILK_COLOUR_RED;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 1u);
}

TEST_F(BusSpi, ADeviceThatIsMissingIsNamed) {
  machine.cards.erase(third_card);
  EXPECT_FALSE(open(wiring()));
  EXPECT_THAT(error.text, HasSubstr("device '/dev/spidev7.2' cannot be opened"));
}

TEST_F(BusSpi, ASecondKernelOnTheSameCardsIsRefused) {
  ASSERT_TRUE(open(wiring())) << error.text;
  ilk_bus_spi_t second{};
  const ilk_spi_wiring_t same = wiring();
  EXPECT_FALSE(ilk_bus_spi_open(&second, &same, &error));
  EXPECT_THAT(error.text, HasSubstr("device '/dev/spidev7.0' is used by another process"));
  EXPECT_TRUE(transact()) << "the first one goes on";
  EXPECT_EQ(in.frames_received, 0b101u);
}

TEST_F(BusSpi, ACardThatRefusesItsClockIsNamed) {
  machine.refused_request = static_cast<int>(SPI_IOC_WR_MAX_SPEED_HZ);
  EXPECT_FALSE(open(wiring()));
  EXPECT_THAT(error.text, HasSubstr("device '/dev/spidev7.0' refuses mode 0, 8 bits or 20000000 Hz"));
}

TEST_F(BusSpi, LinesThatAreTakenAreNamedByTheirChip) {
  machine.refused_request = static_cast<int>(GPIO_V2_GET_LINE_IOCTL);
  EXPECT_FALSE(open(wiring()));
  EXPECT_THAT(error.text, HasSubstr("gpio '/dev/gpiochip7' refuses 3 lines"));
}

class SpiWiring : public ::testing::Test {
 protected:
  SpiWiring() {
    config.common.pedal_channels = 2;
    config.axis[0].card = ILK_CARD_PWM;
    config.axis[2].card = ILK_CARD_SENSOR;
  }

  bool load(const std::string& text) {
    const std::string path = folder.file("wiring");
    std::ofstream(path) << text;
    return ilk_spi_wiring_load(path.c_str(), &config, &wired, &error);
  }

  static constexpr const char* sound =
      "# a machine\n"
      "speed_hz 20000000\n\n"
      "card 0 /dev/spidev7.0   # yaw\n"
      "card 2 /dev/spidev7.2\n"
      "gpio /dev/gpiochip7\n"
      "pedal_no 17 low\n"
      "pedal_nc\t27 low\n"
      "estop 22\n"
      "power 23 low\n"
      "lamp stall 5 6 13\n";

  TemporaryDirectory folder;
  ilk_config_t config{};
  ilk_spi_wiring_t wired{};
  ilk_error_t error{};
};

TEST_F(SpiWiring, SaysWhatIsWhere) {
  ASSERT_TRUE(load(sound)) << error.text;
  EXPECT_STREQ(wired.card[0], first_card);
  EXPECT_STREQ(wired.card[1], "");
  EXPECT_STREQ(wired.card[2], third_card);
  EXPECT_STREQ(wired.gpio, "/dev/gpiochip7");
  EXPECT_EQ(wired.speed_hz, 20'000'000u);
  EXPECT_EQ(wired.contact[ILK_CONTACT_PEDAL_NC].offset, 27u);
  EXPECT_TRUE(wired.contact[ILK_CONTACT_PEDAL_NC].active_low);
  EXPECT_FALSE(wired.contact[ILK_CONTACT_ESTOP].active_low);
  EXPECT_EQ(wired.power.offset, power_line);
  EXPECT_TRUE(wired.power.active_low);
  EXPECT_EQ(wired.lamp[ILK_LAMP_STALL][ILK_LED_BLUE].offset, 13u);
  EXPECT_EQ(wired.lamp[ILK_LAMP_PEDAL][ILK_LED_RED].offset, ILK_NO_LINE);
}

TEST_F(SpiWiring, WhatIsWrongIsNamedWithItsLine) {
  struct Wrong {
    const char* line;
    const char* expected;
  };
  for (const Wrong& wrong : {
           Wrong{"card 10 /dev/spidev7.3", "line 12: expected card SLOT DEVICE"},
           Wrong{"card 0 /dev/spidev7.3", "line 12: expected card SLOT DEVICE, once"},
           Wrong{"card 1 spidev7.3", "line 12: expected card SLOT DEVICE"},
           Wrong{"card 1x /dev/spidev7.3", "line 12: expected card SLOT DEVICE"},
           Wrong{"gpio /dev/gpiochip1", "line 12: expected gpio DEVICE, once"},
           Wrong{"estop 22", "line 12: expected LINE [low], once"},
           Wrong{"power 24", "line 12: expected power LINE [low], once"},
           Wrong{"speed_hz 99999", "line 12: expected speed_hz 100000"},
           Wrong{"lamp stall 1 2 3", "line 12: expected lamp"},
           Wrong{"lamp door 1 2 3", "line 12: expected lamp"},
           Wrong{"lamp pedal 1 2", "line 12: expected lamp"},
           Wrong{"lamp pedal 1 2 3 4", "line 12: expected lamp"},
           Wrong{"lamp pedal 1 2 -3", "line 12: expected lamp"},
           Wrong{"brake 4", "line 12: expected speed_hz, card"},
           Wrong{"lamp pedal 17 2 3", "a gpio line has two uses"},
           Wrong{"lamp pedal 23 2 3", "a gpio line has two uses"},
           Wrong{"card 1 /dev/spidev7.1", "slot 1 has no card in the configuration"},
       }) {
    EXPECT_FALSE(load(std::string(sound) + wrong.line + "\n")) << wrong.line;
    EXPECT_THAT(error.text, HasSubstr(wrong.expected)) << wrong.line;
  }
}

TEST_F(SpiWiring, WhatIsMissingIsNamed) {
  const auto without = [](const std::string& line) {
    std::string text = sound;
    text.erase(text.find(line), line.size());
    return text;
  };
  EXPECT_FALSE(load(without("card 2 /dev/spidev7.2\n")));
  EXPECT_THAT(error.text, HasSubstr("slot 2 has a card in the configuration"));
  EXPECT_FALSE(load(without("speed_hz 20000000\n")));
  EXPECT_THAT(error.text, HasSubstr("speed_hz is missing"));
  for (const char* const line :
       {"gpio /dev/gpiochip7\n", "pedal_no 17 low\n", "pedal_nc\t27 low\n", "estop 22\n", "power 23 low\n"}) {
    EXPECT_FALSE(load(without(line))) << line;
    EXPECT_THAT(error.text, HasSubstr("expected gpio, estop, power, pedal_no and a pedal_nc")) << line;
  }
  config.common.pedal_channels = 1;
  EXPECT_FALSE(load(sound));
  EXPECT_THAT(error.text, HasSubstr("no pedal_nc: the pedal has 1 channels"));
  EXPECT_TRUE(load(without("pedal_nc\t27 low\n"))) << error.text;
}

}  // namespace
