/**
 * @file
 * The bus of real cards: Linux spidev for the frames, the GPIO character device for contacts and lamps.
 *
 * Every ioctl of the executive is in bus_spi.c. Each card has a chip select, thus a device, of its own; all
 * are transacted one after the other in each tick. The contacts are read last, so that the kernel decides on
 * the newest. How long a transaction takes is bounded by the words and the clock; a controller that hangs is
 * given up by its own driver, and seen here as a card that did not answer.
 */
#ifndef INTERLOCK_HOST_BUS_SPI_H
#define INTERLOCK_HOST_BUS_SPI_H

#include <stddef.h>
#include <stdint.h>

#include "bus.h"
#include "error.h"
#include "spi_wiring.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ILK_FRAME_BYTES ((size_t)ILK_FRAME_WORDS * sizeof(uint32_t))

typedef struct {
  int card[ILK_SLOTS]; /**< descriptor of each slot, -1 where there is no card */
  int contacts;        /**< descriptor of the input lines */
  int power;           /**< descriptor of the line of the amplifiers' supply */
  int lamps;           /**< descriptor of the output lines, -1 when none is wired */
  uint32_t speed_hz;
  bool two_channels;
  uint64_t shown; /**< lines of lamps as last set */
  uint64_t lights[ILK_LAMP_COUNT]
                 [ILK_LED_COUNT]; /**< bit of each light among the output lines, 0: not wired */
  uint8_t sent[ILK_FRAME_BYTES];
  uint8_t received[ILK_FRAME_BYTES];
} ilk_bus_spi_t;

/** Opens and sets up every device of the wiring, each for this process alone. Nothing is sent yet. */
bool ilk_bus_spi_open(ilk_bus_spi_t *spi, const ilk_spi_wiring_t *wiring, ilk_error_t *error);

/** The driver for the loop. */
ilk_bus_t ilk_bus_spi_driver(ilk_bus_spi_t *spi);

/** Closes every device. The cards drop their amplifiers by themselves. */
void ilk_bus_spi_close(ilk_bus_spi_t *spi);

#ifdef __cplusplus
}
#endif

#endif
