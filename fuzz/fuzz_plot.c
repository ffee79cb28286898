/* SPDX-License-Identifier: BSD-3-Clause */
/* Results files as `se3d plot` reads them: the table, the choice of curves, amplitude spectra and
 * the script for gnuplot. What follows a form feed in the input is the scene beside the table. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../tools/se3d/plot.h"

/* Every line of a script ends what it quotes, and no byte of it is one that a terminal or gnuplot
 * acts on. */
static void check_script(const char *path)
{
    int quotes = 0;
    FILE *file = fopen(path, "rb");
    FUZZ_MUST(file != NULL);
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        FUZZ_MUST(c == '\n' || (c >= ' ' && c != 0x7F));
        FUZZ_MUST(c != '\n' || quotes % 2 == 0);
        quotes = c == '\n' ? 0 : quotes + (c == '\'');
    }
    fclose(file);
}

static void draw(plot *p, const char *csv, const char *script)
{
    p->files[0] = csv;
    p->file_count = 1;
    snprintf(p->base, sizeof p->base, "%.*s", (int)(strlen(csv) - strlen(".csv")), csv);
    if (!table_read(&p->tables[0], "plot", csv)) {
        return;
    }
    if (plot_choose(p) && (!p->fft || plot_transform(p))) {
        FUZZ_MUST(plot_write_script(p, script));
        check_script(script);
    }
    table_destroy(&p->tables[0]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *cut = size > 0 ? memchr(data, '\f', size) : NULL;
    const size_t rows = cut ? (size_t)(cut - data) : size;
    plot *p = calloc(1, sizeof *p);
    if (!p) {
        return 0;
    }
    const char *csv = fuzz_write_file("a.csv", data, rows);
    (void)fuzz_write_file("scene.glb", cut ? cut + 1 : data, cut ? size - rows - 1 : 0);
    (void)fuzz_write_file("a.fft.csv", data, 0);
    const char *script = fuzz_write_file("a.gp", data, 0);
    p->fft = size % 2 == 1;
    draw(p, csv, script);
    free(p);
    return 0;
}
