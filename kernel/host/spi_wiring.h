/**
 * @file
 * How the cards, the pedal, the E-stop, the amplifiers' supply and the lamps of one machine are wired to the
 * processor.
 *
 * A text file, one thing a line; `#` begins a comment:
 *
 *     speed_hz 20000000              clock of all cards, 100000 to 50000000
 *     card 0 /dev/spidev0.0          the card in slot 0; one line for each card of the configuration
 *     gpio /dev/gpiochip0            where the lines below are
 *     pedal_no 17 low                contact by line; `low`: closed pulls the line low
 *     pedal_nc 27 low                where the pedal has two channels
 *     estop 22 low                   the loop, closed when all is clear
 *     power 24                       line that switches the amplifiers' supply on; `low`: pulling it low does
 *     lamp controller 5 6 13         red, green and blue of a lamp: pedal, network, controller, stall
 */
#ifndef INTERLOCK_HOST_SPI_WIRING_H
#define INTERLOCK_HOST_SPI_WIRING_H

#include <stdint.h>

#include "error.h"
#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ILK_DEVICE_PATH_BYTES 64u
#define ILK_NO_LINE UINT32_MAX

/* Contacts, in the order in which they are requested and read. */
#define ILK_CONTACT_PEDAL_NO 0u
#define ILK_CONTACT_PEDAL_NC 1u
#define ILK_CONTACT_ESTOP 2u
#define ILK_CONTACT_COUNT 3u

/* Lights of a lamp. */
#define ILK_LED_RED 0u
#define ILK_LED_GREEN 1u
#define ILK_LED_BLUE 2u
#define ILK_LED_COUNT 3u

/** A line of the GPIO chip. */
typedef struct {
  uint32_t offset; /**< on the chip; ILK_NO_LINE: not wired */
  bool active_low;
} ilk_line_t;

/** Which devices and lines the robot's cards, contacts and lamps are on. */
typedef struct {
  char card[ILK_SLOTS][ILK_DEVICE_PATH_BYTES]; /**< device of each slot, empty where there is no card */
  char gpio[ILK_DEVICE_PATH_BYTES];
  uint32_t speed_hz;
  ilk_line_t contact[ILK_CONTACT_COUNT];
  ilk_line_t power;
  ilk_line_t lamp[ILK_LAMP_COUNT][ILK_LED_COUNT];
} ilk_spi_wiring_t;

/**
 * Reads the file and holds it against the configuration: exactly its cards, E-stop, pedal channels and
 * power are wired.
 *
 * @return false with the file, the line and what was expected.
 */
bool ilk_spi_wiring_load(const char *path, const ilk_config_t *config, ilk_spi_wiring_t *wiring,
                         ilk_error_t *error);

#ifdef __cplusplus
}
#endif

#endif
