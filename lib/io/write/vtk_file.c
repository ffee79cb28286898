/* SPDX-License-Identifier: BSD-3-Clause */
/* .vtp and .vti files: VTK's PolyData and ImageData in XML with appended raw data. Every array is
 * preceded by its size in bytes; or, compressed by blocks, by how many there are, the size of one
 * and of a shorter last one before that (0: none), and their sizes. All of these are 64 bits. */
#include "io/write/vtk_file.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>

#include "io/base/deflate.h"
#include "io/base/file.h"
#include "io/base/little.h"
#include "io/base/number.h"
#include "io/base/pool.h"

enum { BLOCK = 4096, COMPRESSED = 1 << 15 };

/* Values [first, end) of an array, one by one, as bytes. */
static void get_bytes(const se3di_vtk_array *a, size_t first, size_t end, unsigned char *to)
{
    for (size_t n = first; n < end; ++n, to += 4) {
        const double value = se3di_vtk_value(a, n / a->width, n % a->width);
        const float single = (float)value;
        uint32_t bits = 0;
        memcpy(&bits, &single, sizeof bits);
        se3di_little_put(to, a->whole ? (uint32_t)(int32_t)value : bits, 4);
    }
}

static void put_data(FILE *file, const se3di_vtk_array *a)
{
    unsigned char block[4 * BLOCK];
    const size_t count = a->count * a->width;
    se3di_little_put(block, 4 * (uint64_t)count, 8);
    fwrite(block, 1, 8, file);
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t end = count - first < BLOCK ? count : first + BLOCK;
        get_bytes(a, first, end, block);
        fwrite(block, 1, 4 * (end - first), file);
    }
}

static bool append(se3di_iopool *pool, se3di_iobytes *p, const void *data, size_t size)
{
    const bool good = se3di_iobytes_put(p, pool, data, size);
    errno = good ? errno : ENOMEM;
    return good;
}

/* @return false: errno says why */
static bool pack(se3di_deflate *d, const se3di_vtk_array *a, se3di_iobytes *p)
{
    unsigned char block[COMPRESSED];
    const size_t each = COMPRESSED / 4, count = a->count * a->width;
    const size_t blocks = (count + each - 1) / each;
    const uint64_t head[3] = {blocks, COMPRESSED, count % each * 4};
    bool good = true;
    for (size_t k = 0; k < 3 + blocks && good; ++k) { /* sizes follow */
        se3di_little_put(block, k < 3 ? head[k] : 0, 8);
        good = append(d->pool, p, block, 8);
    }
    for (size_t k = 0; k < blocks && good; ++k) {
        const size_t first = k * each, end = k + 1 < blocks ? first + each : count;
        size_t made = 0;
        get_bytes(a, first, end, block);
        const unsigned char *data = se3di_deflate_block(d, block, 4 * (end - first), &made);
        good = data && append(d->pool, p, data, made);
        se3di_little_put(p->data + 8 * (3 + k), made, 8);
    }
    return good;
}

/* "0 3 0 4 0 5" of a grid of 3 x 4 x 5 cells. */
static void put_extent(FILE *file, const char *name, const se3di_vtk_grid *grid)
{
    fprintf(file, " %s=\"0 %d 0 %d 0 %d\"", name, (int)grid->cells[0], (int)grid->cells[1],
            (int)grid->cells[2]);
}

static void put_triple(FILE *file, const char *name, const double values[3])
{
    char text[3][48];
    for (int k = 0; k < 3; ++k) {
        text[k][se3di_number_format(values[k], text[k])] = '\0';
    }
    fprintf(file, " %s=\"%s %s %s\"", name, text[0], text[1], text[2]);
}

static const char *type_of(const se3di_vtk_file *f)
{
    return f->grid ? "ImageData" : "PolyData";
}

static void put_piece(FILE *file, const se3di_vtk_file *f)
{
    if (f->grid) {
        fputs("<ImageData", file);
        put_extent(file, "WholeExtent", f->grid);
        put_triple(file, "Origin", f->grid->origin);
        put_triple(file, "Spacing", f->grid->spacing);
        fputs(">\n<Piece", file);
        put_extent(file, "Extent", f->grid);
        fputs(">\n", file);
        return;
    }
    fprintf(file,
            "<PolyData>\n<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
            "NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
            f->points, f->verts, f->lines, f->polys);
}

/* `data`: of the arrays, compressed; NULL: they are not. */
static void put_head(FILE *file, const se3di_vtk_file *f, const se3di_iobytes *data)
{
    static const char *const names[] = {
#define SE3DI_VTK_ELEMENT(NAME, number, element) [number] = element,
        SE3DI_VTK_SECTION_LIST(SE3DI_VTK_ELEMENT)
#undef SE3DI_VTK_ELEMENT
    };
    const size_t sections = f->grid ? SE3DI_VTK_CELL_DATA + 1 : SE3DI_VTK_SECTION_COUNT;
    size_t offset = 0;
    size_t k = 0;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\"%s>\n",
            type_of(f), data ? " compressor=\"vtkZLibDataCompressor\"" : "");
    put_piece(file, f);
    for (size_t s = 0; s < sections; ++s) {
        fprintf(file, "<%s>\n", names[s]);
        for (; k < f->array_count && (size_t)f->arrays[k].section == s; ++k) {
            const se3di_vtk_array *a = &f->arrays[k];
            fprintf(file,
                    "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
                    "format=\"appended\" offset=\"%zu\"/>\n",
                    a->whole ? "Int32" : "Float32", a->name, a->width, offset);
            offset += data ? data[k].count : 8 + 4 * a->count * a->width;
        }
        fprintf(file, "</%s>\n", names[s]);
    }
    fprintf(file, "</Piece>\n</%s>\n<AppendedData encoding=\"raw\">\n_", type_of(f));
}

static bool write_file(const se3di_vtk_file *f, const char *path, const se3di_iobytes *data)
{
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return false;
    }
    put_head(file, f, data);
    for (size_t k = 0; k < f->array_count; ++k) {
        if (data) {
            fwrite(data[k].data, 1, data[k].count, file);
        } else {
            put_data(file, &f->arrays[k]);
        }
    }
    fputs("\n</AppendedData>\n</VTKFile>\n", file);
    return se3di_partial_close(file, path);
}

/* All arrays are compressed before the first byte is written: the head says where they begin. */
static bool write_packed(const se3di_vtk_file *f, const se3di_vtk_target *to)
{
    se3di_iopool pool;
    se3di_deflate d;
    se3di_iopool_init(&pool, to->allocator);
    se3di_iobytes *data = se3di_iopool_array(&pool, f->array_count, sizeof *data);
    errno = ENOMEM; /* unless something else fails */
    bool good = data && se3di_deflate_open(&d, &pool, to->compression);
    if (good) {
        for (size_t k = 0; k < f->array_count && good; ++k) {
            good = pack(&d, &f->arrays[k], &data[k]);
        }
        const int why = errno;
        se3di_deflate_close(&d);
        errno = why;
    }
    good = good && write_file(f, to->path, data);
    const int why = errno;
    se3di_iopool_destroy(&pool);
    errno = why;
    return good;
}

bool se3di_vtk_file_write(const se3di_vtk_file *f, const se3di_vtk_target *to)
{
    const char *ending = strrchr(to->path, '.');
    if (ending && strcmp(ending, ".vtkhdf") == 0) {
        return se3di_vtk_file_write_hdf5(f, to);
    }
    return to->compression > 0 ? write_packed(f, to) : write_file(f, to->path, NULL);
}
