#include "config_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "config_error_text.h"
#include "interlock/kernel.h"

/** Reads until the buffer is full or the file ends; -1 on failure. */
static ssize_t read_up_to(int descriptor, unsigned char *bytes, size_t wanted) {
  size_t filled = 0;
  while (filled < wanted) {
    const ssize_t got = read(descriptor, &bytes[filled], wanted - filled);
    if (got <= 0) {
      return got < 0 ? -1 : (ssize_t)filled;
    }
    filled += (size_t)got;
  }
  return (ssize_t)filled;
}

static bool read_config(const char *path, ilk_config_t *config, ilk_error_t *error) {
  unsigned char bytes[sizeof *config + 1u];
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return ilk_fail(error, "configuration '%s' cannot be opened: %s", path, strerror(errno));
  }
  const ssize_t length = read_up_to(descriptor, bytes, sizeof bytes);
  const int reason = errno;
  (void)close(descriptor);
  if (length < 0) {
    return ilk_fail(error, "configuration '%s' cannot be read: %s", path, strerror(reason));
  }
  if (length != (ssize_t)sizeof *config) {
    return ilk_fail(
        error,
        "configuration '%s' has %s%zd bytes; expected %zu; compile it with `interlock model compile` of "
        "this release",
        path, length > (ssize_t)sizeof *config ? "at least " : "", length, sizeof *config);
  }
  (void)memcpy(config, bytes, sizeof *config);
  return true;
}

bool ilk_config_load(const char *path, ilk_config_t *config, ilk_error_t *error) {
  if (!read_config(path, config, error)) {
    return false;
  }
  const ilk_config_verdict_t verdict = ilk_config_validate(config);
  if (verdict.error == (uint32_t)ILK_CONFIG_ERROR_NONE) {
    return true;
  }
  const ilk_config_error_text_t text = ilk_config_error_text(verdict.error);
  if (verdict.slot < (uint32_t)ILK_SLOTS) {
    return ilk_fail(error, "configuration '%s' refused, slot %u: %s: %s", path, verdict.slot, text.name,
                    text.meaning);
  }
  return ilk_fail(error, "configuration '%s' refused: %s: %s", path, text.name, text.meaning);
}
