/**
 * @file
 * The compiled kernel on every row that the model gave: each answer must be the row's, and so must be the
 * generated table's, from which the proof goes. Prints what differs, then the number of rows and of
 * differences.
 */
#include <stdio.h>
#include <string.h>

#include "case.h"

enum { SHOWN = 5, WIDTH = INPUTS + OUTPUTS };

static const case_t* before_of(const case_t* c) {
  static case_t before;
  before = *c;
  return &before;
}

static int differs(const char* what, long row, int column, int32_t expected, int32_t got, long shown) {
  if (expected == got) {
    return 0;
  }
  if (shown < SHOWN) {
    (void)printf("DIFFERS %s %ld %s %d %d\n", what, row, column_name[column], expected, got);
  }
  return 1;
}

static int32_t table_column(int index, const int32_t* in) {
#define CHECK(column, answer, name) \
  if (index == (column)) {          \
    return (answer);                \
  }
  CHECK_ALL
#undef CHECK
  return 0;
}

static int breaks(const char* what, long row, int holds, long shown) {
  if (!holds && shown < SHOWN) {
    (void)printf("DIFFERS at row %ld: %s\n", row, what);
  }
  return holds ? 0 : 1;
}

/** What is broken of the rest: relations, and that nothing changes but what may. */
static long check_rest(const case_t* c, const case_t* b, long number, long shown) {
  long broken = 0;
#define RELATION(holds, name) broken += breaks(name, number, holds, shown + broken);
  RELATION_ALL
#undef RELATION
  return broken + breaks("something else changed", number, keeps(c, b), shown + broken);
}

static long check_row(const int32_t row[WIDTH], long number, long shown) {
  case_t now;
  int32_t codes[WIDTH];
  long differences = 0;
  memset(&now, 0, sizeof now);
  configure(&now);
  write_inputs(&now, row);
  const case_t* b = before_of(&now);
  read_inputs(b, b, codes);
  for (int i = 0; i < INPUTS; ++i) {
    differences += differs("input", number, i, row[i], codes[i], shown + differences);
  }
  differences += breaks("the proof does not look at it", number, may_be(&now), shown + differences);
  call(&now);
  read_outputs(&now, b, codes + INPUTS);
  for (int i = 0; i < OUTPUTS; ++i) {
    differences +=
        differs("kernel", number, INPUTS + i, row[INPUTS + i], codes[INPUTS + i], shown + differences);
    differences +=
        differs("table", number, INPUTS + i, row[INPUTS + i], table_column(i, row), shown + differences);
  }
  differences += breaks("it is not in the table", number, has_row(row), shown + differences);
  return differences + check_rest(&now, b, number, shown + differences);
}

int main(int count, char** arguments) {
  FILE* file = (count == 2) ? fopen(arguments[1], "rb") : NULL;
  if (file == NULL) {
    (void)fprintf(stderr, "usage: run_rows FILE, with rows of %d words\n", (int)WIDTH);
    return 2;
  }
  int32_t row[WIDTH];
  long rows = 0;
  long differences = 0;
  while (fread(row, sizeof row, 1, file) == 1) {
    differences += check_row(row, rows, differences);
    rows++;
  }
  (void)fclose(file);
  (void)printf("ROWS %ld DIFFERENCES %ld\n", rows, differences);
  return differences == 0 ? 0 : 1;
}
