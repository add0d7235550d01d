#include "spi_wiring.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TEXT_BYTES ((size_t)8192u)
#define WORDS_MAX 6u
#define SPEED_HZ_MIN 100000u
#define SPEED_HZ_MAX 50000000u
#define LINE_OFFSET_MAX 1023u
#define LAMP_WORDS (2u + ILK_LED_COUNT)

/** The words of one line; a word after the last one that may be there is kept, so that it is refused. */
typedef struct {
  size_t count;
  char *word[WORDS_MAX];
} words_t;

static words_t words_of_line(char *line) {
  words_t words = {0};
  char *rest = NULL;
  line[strcspn(line, "#")] = '\0';
  char *word = strtok_r(line, " \t", &rest);
  while (word != NULL && words.count < WORDS_MAX) {
    words.word[words.count] = word;
    words.count += 1u;
    word = strtok_r(NULL, " \t", &rest);
  }
  return words;
}

static bool read_number(const char *word, uint32_t least, uint32_t most, uint32_t *number) {
  char *end = NULL;
  errno = 0;
  const long value = strtol(word, &end, 10);
  if (errno != 0 || end == word || *end != '\0' || value < (long)least || value > (long)most) {
    return false;
  }
  *number = (uint32_t)value;
  return true;
}

static bool read_path(const char *word, char path[ILK_DEVICE_PATH_BYTES]) {
  const size_t length = strlen(word);
  if (word[0] != '/' || length >= ILK_DEVICE_PATH_BYTES || path[0] != '\0') {
    return false;
  }
  (void)memcpy(path, word, length + 1u);
  return true;
}

/** A line of the chip that nothing else has taken. */
static bool read_line(const char *word, ilk_line_t *line) {
  return line->offset == ILK_NO_LINE && read_number(word, 0u, LINE_OFFSET_MAX, &line->offset);
}

static bool read_wired_card(const words_t *words, ilk_spi_wiring_t *wiring) {
  uint32_t slot = 0u;
  return words->count == 3u && read_number(words->word[1], 0u, (uint32_t)ILK_SLOTS - 1u, &slot) &&
         read_path(words->word[2], wiring->card[slot]);
}

/** A contact, or the line of the power. */
static bool read_level(const words_t *words, ilk_line_t *line) {
  line->active_low = words->count == 3u;
  return (words->count == 2u || (words->count == 3u && strcmp(words->word[2], "low") == 0)) &&
         read_line(words->word[1], line);
}

static bool read_lamp(const words_t *words, ilk_spi_wiring_t *wiring) {
  static const char *const names[ILK_LAMP_COUNT] = {
      [ILK_LAMP_PEDAL] = "pedal",
      [ILK_LAMP_NETWORK] = "network",
      [ILK_LAMP_CONTROLLER] = "controller",
      [ILK_LAMP_STALL] = "stall",
  };
  if (words->count != LAMP_WORDS) {
    return false;
  }
  for (size_t lamp = 0; lamp < (size_t)ILK_LAMP_COUNT; ++lamp) {
    if (strcmp(words->word[1], names[lamp]) == 0) {
      ilk_line_t *lines = wiring->lamp[lamp];
      return read_line(words->word[2], &lines[ILK_LED_RED]) &&
             read_line(words->word[3], &lines[ILK_LED_GREEN]) &&
             read_line(words->word[4], &lines[ILK_LED_BLUE]);
    }
  }
  return false;
}

/** Returns NULL when the line was taken, otherwise what was expected. */
static const char *take_line(const words_t *words, ilk_spi_wiring_t *wiring) {
  static const char *const contacts[ILK_CONTACT_COUNT] = {
      [ILK_CONTACT_PEDAL_NO] = "pedal_no",
      [ILK_CONTACT_PEDAL_NC] = "pedal_nc",
      [ILK_CONTACT_ESTOP] = "estop",
  };
  const char *key = words->word[0];
  for (size_t contact = 0; contact < ILK_CONTACT_COUNT; ++contact) {
    if (strcmp(key, contacts[contact]) == 0) {
      return read_level(words, &wiring->contact[contact]) ? NULL : "LINE [low], once";
    }
  }
  if (strcmp(key, "card") == 0) {
    return read_wired_card(words, wiring) ? NULL : "card SLOT DEVICE, once for each slot";
  }
  if (strcmp(key, "gpio") == 0) {
    return words->count == 2u && read_path(words->word[1], wiring->gpio) ? NULL : "gpio DEVICE, once";
  }
  if (strcmp(key, "power") == 0) {
    return read_level(words, &wiring->power) ? NULL : "power LINE [low], once";
  }
  if (strcmp(key, "lamp") == 0) {
    return read_lamp(words, wiring) ? NULL
                                    : "lamp pedal|network|controller|stall RED GREEN BLUE, once for each";
  }
  if (strcmp(key, "speed_hz") == 0) {
    return words->count == 2u && read_number(words->word[1], SPEED_HZ_MIN, SPEED_HZ_MAX, &wiring->speed_hz)
               ? NULL
               : "speed_hz 100000 to 50000000";
  }
  return "speed_hz, card, gpio, pedal_no, pedal_nc, estop, power or lamp";
}

/** Takes the text line by line; it is cut up on the way. */
static bool take_text(const char *path, char *text, ilk_spi_wiring_t *wiring, ilk_error_t *error) {
  char *line = text;
  uint32_t number = 0u;
  while (line != NULL) {
    char *next = strchr(line, (int)'\n');
    if (next != NULL) {
      *next = '\0';
      next = &next[1];
    }
    number += 1u;
    const words_t words = words_of_line(line);
    const char *expected = words.count == 0u ? NULL : take_line(&words, wiring);
    if (expected != NULL) {
      return ilk_fail(error, "wiring '%s', line %u: expected %s", path, number, expected);
    }
    line = next;
  }
  return true;
}

/** Reads the whole file; the text ends with a zero. */
static bool read_text(const char *path, char text[TEXT_BYTES], ilk_error_t *error) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return ilk_fail(error, "wiring '%s' cannot be opened: %s", path, strerror(errno));
  }
  size_t filled = 0;
  ssize_t got = 1;
  while (got > 0 && filled < TEXT_BYTES) {
    got = read(descriptor, &text[filled], TEXT_BYTES - filled);
    filled += got > 0 ? (size_t)got : 0u;
  }
  const int reason = errno;
  (void)close(descriptor);
  if (got < 0) {
    return ilk_fail(error, "wiring '%s' cannot be read: %s", path, strerror(reason));
  }
  if (filled == TEXT_BYTES) {
    return ilk_fail(error, "wiring '%s' has %zu bytes or more; expected fewer", path, filled);
  }
  text[filled] = '\0';
  return true;
}

/** Notes a line that is wired. False when something else has it. */
static bool take_use(uint8_t used[LINE_OFFSET_MAX + 1u], const ilk_line_t *line) {
  const bool free = line->offset == ILK_NO_LINE || used[line->offset] == 0u;
  if (line->offset != ILK_NO_LINE) {
    used[line->offset] = 1u;
  }
  return free;
}

/** Two uses of one line would let a lamp move a contact. */
static bool is_shared(const ilk_spi_wiring_t *wiring) {
  uint8_t used[LINE_OFFSET_MAX + 1u] = {0};
  bool alone = take_use(used, &wiring->power);
  for (size_t contact = 0; contact < ILK_CONTACT_COUNT; ++contact) {
    alone = take_use(used, &wiring->contact[contact]) && alone;
  }
  for (size_t lamp = 0; lamp < (size_t)ILK_LAMP_COUNT; ++lamp) {
    for (size_t led = 0; led < ILK_LED_COUNT; ++led) {
      alone = take_use(used, &wiring->lamp[lamp][led]) && alone;
    }
  }
  return !alone;
}

static bool check(const char *path, const ilk_config_t *config, const ilk_spi_wiring_t *wiring,
                  ilk_error_t *error) {
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; ++slot) {
    const bool configured = config->axis[slot].card != (uint32_t)ILK_CARD_NONE;
    if (configured != (wiring->card[slot][0] != '\0')) {
      return ilk_fail(error, "wiring '%s': slot %u has %s in the configuration; expected the same here", path,
                      slot, configured ? "a card" : "no card");
    }
  }
  const bool two_channels = config->common.pedal_channels == 2u;
  if (wiring->gpio[0] == '\0' || wiring->contact[ILK_CONTACT_PEDAL_NO].offset == ILK_NO_LINE ||
      wiring->contact[ILK_CONTACT_ESTOP].offset == ILK_NO_LINE || wiring->power.offset == ILK_NO_LINE ||
      (wiring->contact[ILK_CONTACT_PEDAL_NC].offset != ILK_NO_LINE) != two_channels) {
    return ilk_fail(
        error,
        "wiring '%s': expected gpio, estop, power, pedal_no and %s pedal_nc: the pedal has %u channels", path,
        two_channels ? "a" : "no", config->common.pedal_channels);
  }
  if (wiring->speed_hz == 0u) {
    return ilk_fail(error, "wiring '%s': speed_hz is missing", path);
  }
  return !is_shared(wiring) || ilk_fail(error, "wiring '%s': a gpio line has two uses", path);
}

bool ilk_spi_wiring_load(const char *path, const ilk_config_t *config, ilk_spi_wiring_t *wiring,
                         ilk_error_t *error) {
  *wiring = (ilk_spi_wiring_t){.power = {.offset = ILK_NO_LINE}};
  for (size_t contact = 0; contact < ILK_CONTACT_COUNT; ++contact) {
    wiring->contact[contact].offset = ILK_NO_LINE;
  }
  for (size_t lamp = 0; lamp < (size_t)ILK_LAMP_COUNT; ++lamp) {
    for (size_t led = 0; led < ILK_LED_COUNT; ++led) {
      wiring->lamp[lamp][led].offset = ILK_NO_LINE;
    }
  }
  char text[TEXT_BYTES];
  return read_text(path, text, error) && take_text(path, text, wiring, error) &&
         check(path, config, wiring, error);
}
