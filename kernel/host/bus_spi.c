#include "bus_spi.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <linux/spi/spidev.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define BITS_PER_BYTE 8u
#define NO_DEVICE (-1)

/** Opened by one process at a time: a second kernel on the same cards is refused. */
static int open_device(const char *path, ilk_error_t *error) {
  const int descriptor = open(path, O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    (void)ilk_fail(error, "device '%s' cannot be opened: %s", path, strerror(errno));
    return NO_DEVICE;
  }
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    (void)ilk_fail(error, "device '%s' is used by another process: %s", path, strerror(errno));
    (void)close(descriptor);
    return NO_DEVICE;
  }
  return descriptor;
}

static bool set_up_card(int descriptor, const char *path, uint32_t speed_hz, ilk_error_t *error) {
  uint32_t mode = SPI_MODE_0;
  uint8_t bits = BITS_PER_BYTE;
  uint32_t speed = speed_hz;
  if (ioctl(descriptor, SPI_IOC_WR_MODE32, &mode) < 0 ||
      ioctl(descriptor, SPI_IOC_WR_BITS_PER_WORD, &bits) < 0 ||
      ioctl(descriptor, SPI_IOC_WR_MAX_SPEED_HZ, &speed) < 0) {
    return ilk_fail(error, "device '%s' refuses mode 0, 8 bits or %u Hz: %s", path, speed_hz,
                    strerror(errno));
  }
  return true;
}

static bool open_cards(ilk_bus_spi_t *spi, const ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  for (size_t slot = 0; slot < (size_t)ILK_SLOTS; ++slot) {
    const char *path = wiring->card[slot];
    if (path[0] != '\0') {
      spi->card[slot] = open_device(path, error);
      if (spi->card[slot] < 0 || !set_up_card(spi->card[slot], path, wiring->speed_hz, error)) {
        return false;
      }
    }
  }
  return true;
}

/** Returns the descriptor of the requested lines, or -1 with the reason. */
static int request_lines(int chip, const char *path, struct gpio_v2_line_request *request,
                         ilk_error_t *error) {
  static const char consumer[] = "interlock-kernel";
  (void)memcpy(request->consumer, consumer, sizeof consumer);
  if (ioctl(chip, GPIO_V2_GET_LINE_IOCTL, request) < 0) {
    (void)ilk_fail(error, "gpio '%s' refuses %u lines: %s; is one of them taken?", path, request->num_lines,
                   strerror(errno));
    return NO_DEVICE;
  }
  return request->fd;
}

/** Pulled to where an open contact is, so that a wire that breaks reads as one. */
static bool request_contacts(ilk_bus_spi_t *spi, int chip, const ilk_spi_wiring_t *wiring,
                             ilk_error_t *error) {
  struct gpio_v2_line_request request = {
      .config = {.flags = GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN}};
  uint64_t low = 0u;
  for (size_t contact = 0; contact < ILK_CONTACT_COUNT; ++contact) {
    const ilk_line_t *line = &wiring->contact[contact];
    if (line->offset != ILK_NO_LINE) {
      low |= line->active_low ? (uint64_t)1u << request.num_lines : 0u;
      request.offsets[request.num_lines] = line->offset;
      request.num_lines += 1u;
    }
  }
  if (low != 0u) {
    request.config.num_attrs = 1u;
    request.config.attrs[0].mask = low;
    request.config.attrs[0].attr.id = GPIO_V2_LINE_ATTR_ID_FLAGS;
    request.config.attrs[0].attr.flags =
        GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_BIAS_PULL_UP | GPIO_V2_LINE_FLAG_ACTIVE_LOW;
  }
  spi->contacts = request_lines(chip, wiring->gpio, &request, error);
  return spi->contacts >= 0;
}

/** Off at first, and once the kernel is gone: the contactor needs its level to stay. */
static bool request_power(ilk_bus_spi_t *spi, int chip, const ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  struct gpio_v2_line_request request = {.num_lines = 1u, .config = {.flags = GPIO_V2_LINE_FLAG_OUTPUT}};
  request.offsets[0] = wiring->power.offset;
  if (wiring->power.active_low) {
    request.config.flags |= GPIO_V2_LINE_FLAG_ACTIVE_LOW;
  }
  spi->power = request_lines(chip, wiring->gpio, &request, error);
  return spi->power >= 0;
}

/** All dark at first. */
static bool request_lamps(ilk_bus_spi_t *spi, int chip, const ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  struct gpio_v2_line_request request = {.config = {.flags = GPIO_V2_LINE_FLAG_OUTPUT}};
  for (size_t lamp = 0; lamp < (size_t)ILK_LAMP_COUNT; ++lamp) {
    for (size_t led = 0; led < ILK_LED_COUNT; ++led) {
      const ilk_line_t *line = &wiring->lamp[lamp][led];
      if (line->offset != ILK_NO_LINE) {
        spi->lights[lamp][led] = (uint64_t)1u << request.num_lines;
        request.offsets[request.num_lines] = line->offset;
        request.num_lines += 1u;
      }
    }
  }
  if (request.num_lines == 0u) {
    return true;
  }
  spi->lamps = request_lines(chip, wiring->gpio, &request, error);
  return spi->lamps >= 0;
}

/** The chip itself is only needed to ask for its lines. */
static bool open_lines(ilk_bus_spi_t *spi, const ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  const int chip = open_device(wiring->gpio, error);
  if (chip < 0) {
    return false;
  }
  const bool opened = request_contacts(spi, chip, wiring, error) && request_power(spi, chip, wiring, error) &&
                      request_lamps(spi, chip, wiring, error);
  (void)close(chip);
  return opened;
}

bool ilk_bus_spi_open(ilk_bus_spi_t *spi, const ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  *spi = (ilk_bus_spi_t){.contacts = NO_DEVICE,
                         .lamps = NO_DEVICE,
                         .power = NO_DEVICE,
                         .speed_hz = wiring->speed_hz,
                         .two_channels = wiring->contact[ILK_CONTACT_PEDAL_NC].offset != ILK_NO_LINE};
  for (size_t slot = 0; slot < (size_t)ILK_SLOTS; ++slot) {
    spi->card[slot] = NO_DEVICE;
  }
  if (open_cards(spi, wiring, error) && open_lines(spi, wiring, error)) {
    return true;
  }
  ilk_bus_spi_close(spi);
  return false;
}

static void close_one(int *descriptor) {
  if (*descriptor >= 0) {
    (void)close(*descriptor);
    *descriptor = NO_DEVICE;
  }
}

void ilk_bus_spi_close(ilk_bus_spi_t *spi) {
  for (size_t slot = 0; slot < (size_t)ILK_SLOTS; ++slot) {
    close_one(&spi->card[slot]);
  }
  close_one(&spi->contacts);
  close_one(&spi->power);
  close_one(&spi->lamps);
}

/** Words go over the wire with their highest byte first. */
static void to_bytes(const uint32_t words[ILK_FRAME_WORDS], uint8_t bytes[ILK_FRAME_BYTES]) {
  for (size_t word = 0; word < (size_t)ILK_FRAME_WORDS; ++word) {
    const size_t first = word * sizeof words[0];
    bytes[first] = (uint8_t)(words[word] >> 24);
    bytes[first + 1u] = (uint8_t)((words[word] >> 16) & 0xFFu);
    bytes[first + 2u] = (uint8_t)((words[word] >> 8) & 0xFFu);
    bytes[first + 3u] = (uint8_t)(words[word] & 0xFFu);
  }
}

static void to_words(const uint8_t bytes[ILK_FRAME_BYTES], uint32_t words[ILK_FRAME_WORDS]) {
  for (size_t word = 0; word < (size_t)ILK_FRAME_WORDS; ++word) {
    const size_t first = word * sizeof words[0];
    words[word] = ((uint32_t)bytes[first] << 24) | ((uint32_t)bytes[first + 1u] << 16) |
                  ((uint32_t)bytes[first + 2u] << 8) | (uint32_t)bytes[first + 3u];
  }
}

/** Whether all words went out and came in. */
static bool exchange_with(ilk_bus_spi_t *spi, size_t slot, const uint32_t out[ILK_FRAME_WORDS],
                          uint32_t in[ILK_FRAME_WORDS]) {
  const struct spi_ioc_transfer transfer = {.tx_buf = (uint64_t)(uintptr_t)spi->sent,
                                            .rx_buf = (uint64_t)(uintptr_t)spi->received,
                                            .len = (uint32_t)ILK_FRAME_BYTES,
                                            .speed_hz = spi->speed_hz,
                                            .bits_per_word = BITS_PER_BYTE};
  to_bytes(out, spi->sent);
  const int moved = ioctl(spi->card[slot], SPI_IOC_MESSAGE(1), &transfer);
  if (moved < 0 || (uint32_t)moved != transfer.len) {
    return false;
  }
  to_words(spi->received, in);
  return true;
}

static uint32_t exchange_all(ilk_bus_spi_t *spi, const ilk_outputs_t *out, ilk_inputs_t *in) {
  uint32_t received = 0u;
  uint32_t bit = 1u;
  for (size_t slot = 0; slot < (size_t)ILK_SLOTS; ++slot) {
    if (spi->card[slot] >= 0 && exchange_with(spi, slot, out->frame[slot], in->frame[slot])) {
      received |= bit;
    }
    bit <<= 1;
  }
  return received;
}

static uint32_t is_closed(const struct gpio_v2_line_values *values, uint64_t contact) {
  return (values->bits & contact) != 0u ? 1u : 0u;
}

/** All contacts at one moment, in the order in which they were requested. */
static bool read_contacts(const ilk_bus_spi_t *spi, ilk_inputs_t *in) {
  const uint64_t no = 1u;
  const uint64_t nc = spi->two_channels ? 2u : 0u;
  const uint64_t estop = spi->two_channels ? 4u : 2u;
  struct gpio_v2_line_values values = {.bits = 0u, .mask = no | nc | estop};
  if (ioctl(spi->contacts, GPIO_V2_LINE_GET_VALUES_IOCTL, &values) < 0) {
    return false;
  }
  in->pedal_no_closed = is_closed(&values, no);
  in->pedal_nc_closed = is_closed(&values, nc);
  in->estop_loop_closed = is_closed(&values, estop);
  return true;
}

static uint64_t lights_of(const ilk_bus_spi_t *spi, size_t lamp, uint32_t colour) {
  const uint64_t red = spi->lights[lamp][ILK_LED_RED];
  const uint64_t green = spi->lights[lamp][ILK_LED_GREEN];
  const uint64_t blue = spi->lights[lamp][ILK_LED_BLUE];
  switch (colour) {
    case (uint32_t)ILK_COLOUR_GREEN:
      return green;
    case (uint32_t)ILK_COLOUR_RED:
      return red;
    case (uint32_t)ILK_COLOUR_AMBER:
      return red | green;
    case (uint32_t)ILK_COLOUR_PURPLE:
      return red | blue;
    default:
      return 0u;
  }
}

/** Only what changed is set. A lamp that cannot be set is tried again in the next tick; nothing depends on
 * it. */
static void show_lamps(ilk_bus_spi_t *spi, const ilk_outputs_t *out) {
  struct gpio_v2_line_values values = {0};
  for (size_t lamp = 0; lamp < (size_t)ILK_LAMP_COUNT; ++lamp) {
    values.bits |= lights_of(spi, lamp, out->lamp[lamp]);
  }
  values.mask = values.bits ^ spi->shown;
  if (spi->lamps >= 0 && values.mask != 0u &&
      ioctl(spi->lamps, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) >= 0) {
    spi->shown = values.bits;
  }
}

/** Set in each tick, so that a line that was disturbed comes back. Without it the bus is as good as lost. */
static bool switch_power(const ilk_bus_spi_t *spi, const ilk_outputs_t *out) {
  struct gpio_v2_line_values values = {.bits = out->power == 1u ? 1u : 0u, .mask = 1u};
  return ioctl(spi->power, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) >= 0;
}

/** There is always another side to wait for: the clock. */
static bool transact_cards(void *driver, uint32_t tick, const ilk_outputs_t *out, ilk_inputs_t *in) {
  ilk_bus_spi_t *spi = driver;
  (void)tick;
  const uint32_t received = exchange_all(spi, out, in);
  const bool switched = switch_power(spi, out);
  show_lamps(spi, out);
  in->transaction_done = 0u;
  in->frames_received = 0u;
  if (read_contacts(spi, in) && switched && received != 0u) {
    in->transaction_done = 1u;
    in->frames_received = received;
  }
  return true;
}

ilk_bus_t ilk_bus_spi_driver(ilk_bus_spi_t *spi) {
  return (ilk_bus_t){.driver = spi, .simulated = false, .transact = transact_cards};
}
