/* SPDX-License-Identifier: BSD-3-Clause */
/* HDF5 by its published format: superblock 2, object headers 2, links and attributes as messages of
 * them, arrays in one piece, or in pieces that are shuffled, compressed and found by a B-tree.
 * Values come first, then trees, the headers of arrays, of groups, of the root; the superblock,
 * which says where that is, is written at last.                                    docs/hdf5.md */
#include "io/write/hdf5.h"

#include <errno.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/little.h"

#define NOWHERE UINT64_MAX

enum {
    SUPERBLOCK = 48,
    ALIGN = 8,
    /* messages of an object header */
    MESSAGE_DATASPACE = 0x01,
    MESSAGE_LINK_INFO = 0x02,
    MESSAGE_DATATYPE = 0x03,
    MESSAGE_FILL = 0x05,
    MESSAGE_LINK = 0x06,
    MESSAGE_LAYOUT = 0x08,
    MESSAGE_GROUP_INFO = 0x0a,
    MESSAGE_FILTERS = 0x0b,
    MESSAGE_ATTRIBUTE = 0x0c,
    MESSAGE_MOST = 65000, /* bytes */
    /* what is compressed */
    PIECE_BYTES = 1 << 16,
    PIECE_MOST = 1 << 30,
    PIECES_LEAST = 1 << 13, /* of an array: their tree takes 2 kB */
    FILTER_DEFLATE = 1,
    FILTER_SHUFFLE = 2,
    TREE_HEAD = 24,
    TREE_ENTRIES = 64 /* of a node: the format's own number */
};

/* A piece of an array; or a node of its tree, by the first piece below it. */
typedef struct piece {
    uint64_t address, first;
    uint32_t size, reserved; /* compressed */
} piece;

struct se3di_hdf5_node {
    const char *name;
    size_t parent;
    bool is_group;
    se3di_hdf5_shape shape;
    uint64_t data, size;   /* of an array */
    uint64_t header;       /* where it is, once written */
    uint64_t written;      /* bytes of values so far */
    uint64_t piece_size;   /* of an array in pieces, [bytes]; 0: it is in one */
    se3di_iobytes waiting; /* for a piece to be complete */
    piece *pieces;
    size_t piece_count, piece_capacity;
    se3di_iobytes attributes; /* their messages */
    uint64_t children;
};

static void fail(se3di_hdf5 *h, int why)
{
    h->failure = h->failure ? h->failure : why ? why : EIO;
}

/* --- numbers as bytes --- */

static void add(se3di_hdf5 *h, se3di_iobytes *b, const void *data, size_t size)
{
    if (h->failure == 0 && !se3di_iobytes_put(b, &h->pool, data, size)) {
        fail(h, ENOMEM);
    }
}

static void add_word(se3di_hdf5 *h, se3di_iobytes *b, uint64_t bits, size_t size)
{
    unsigned char word[8];
    se3di_little_put(word, bits, size);
    add(h, b, word, size);
}

size_t se3di_hdf5_size_of(const se3di_hdf5_shape *shape)
{
    static const size_t sizes[] = {
#define SE3DI_HDF5_SIZE(NAME, number, bytes) [number] = bytes,
        SE3DI_HDF5_TYPE_LIST(SE3DI_HDF5_SIZE)
#undef SE3DI_HDF5_SIZE
    };
    return shape->type == SE3DI_HDF5_TEXT ? shape->text_size : sizes[shape->type];
}

void se3di_hdf5_put_value(unsigned char *at, se3di_hdf5_type type, double value)
{
    uint64_t bits = 0;
    uint32_t half = 0;
    const float single = (float)value;
    switch (type) {
    case SE3DI_HDF5_DOUBLE:
        memcpy(&bits, &value, sizeof bits);
        se3di_little_put(at, bits, 8);
        break;
    case SE3DI_HDF5_SINGLE:
        memcpy(&half, &single, sizeof half);
        se3di_little_put(at, half, 4);
        break;
    case SE3DI_HDF5_INT64:
        se3di_little_put(at, (uint64_t)(int64_t)value, 8);
        break;
    case SE3DI_HDF5_INT32:
        se3di_little_put(at, (uint32_t)(int32_t)value, 4);
        break;
    default:
        *at = (unsigned char)value;
        break;
    }
}

/* --- the checksum of the format: Jenkins' lookup3 over bytes --- */

static uint32_t turn(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

static void mix(uint32_t v[3])
{
    static const int turns[6] = {4, 6, 8, 16, 19, 4};
    for (int k = 0; k < 6; ++k) {
        uint32_t *a = &v[k % 3], *b = &v[(k + 1) % 3], *c = &v[(k + 2) % 3];
        *a -= *c;
        *a ^= turn(*c, turns[k]);
        *c += *b;
    }
}

static void finish(uint32_t v[3])
{
    static const int turns[7] = {14, 11, 25, 16, 4, 14, 24};
    for (int k = 0; k < 7; ++k) { /* c by b, a by c, b by a, ... */
        uint32_t *to = &v[(k + 2) % 3];
        const uint32_t from = v[(k + 1) % 3];
        *to = (*to ^ from) - turn(from, turns[k]);
    }
}

static uint32_t checksum(const unsigned char *data, size_t size)
{
    const uint32_t start = 0xdeadbeefu + (uint32_t)size;
    uint32_t v[3] = {start, start, start};
    while (size > 12) {
        for (int k = 0; k < 12; ++k) {
            v[k / 4] += (uint32_t)data[k] << (8 * (k % 4));
        }
        mix(v);
        data += 12;
        size -= 12;
    }
    for (size_t k = 0; k < size; ++k) {
        v[k / 4] += (uint32_t)data[k] << (8 * (k % 4));
    }
    if (size > 0) {
        finish(v);
    }
    return v[2];
}

/* --- messages --- */

static void add_message(se3di_hdf5 *h, se3di_iobytes *to, int type, const se3di_iobytes *body)
{
    if (body->count > MESSAGE_MOST) {
        fail(h, EOVERFLOW);
    }
    add_word(h, to, (uint64_t)type, 1);
    add_word(h, to, body->count, 2);
    add_word(h, to, 0, 1);
    add(h, to, body->data, body->count);
}

static void add_dataspace(se3di_hdf5 *h, se3di_iobytes *b, const se3di_hdf5_shape *shape)
{
    const unsigned char head[4] = {2, (unsigned char)shape->rank, 0, shape->rank > 0 ? 1 : 0};
    add(h, b, head, sizeof head);
    for (int k = 0; k < shape->rank; ++k) {
        add_word(h, b, shape->dims[k], 8);
    }
}

static void add_datatype(se3di_hdf5 *h, se3di_iobytes *b, const se3di_hdf5_shape *shape)
{
    const size_t size = se3di_hdf5_size_of(shape);
    if (shape->type == SE3DI_HDF5_TEXT) { /* class 3: filled with zeros, UTF-8 */
        const unsigned char head[4] = {0x13, 0x11, 0, 0};
        add(h, b, head, sizeof head);
        add_word(h, b, size, 4);
        return;
    }
    if (shape->type > SE3DI_HDF5_SINGLE) { /* class 0: signed or not */
        const unsigned char head[4] = {0x10, shape->type == SE3DI_HDF5_UINT8 ? 0 : 8, 0, 0};
        add(h, b, head, sizeof head);
        add_word(h, b, size, 4);
        add_word(h, b, 0, 2);
        add_word(h, b, 8 * size, 2);
        return;
    }
    const bool twice = shape->type == SE3DI_HDF5_DOUBLE; /* class 1: places of its bits */
    const unsigned char head[4] = {0x11, 0x20, twice ? 63 : 31, 0};
    const unsigned char fields[4] = {twice ? 52 : 23, twice ? 11 : 8, 0, twice ? 52 : 23};
    add(h, b, head, sizeof head);
    add_word(h, b, size, 4);
    add_word(h, b, 0, 2);
    add_word(h, b, 8 * size, 2);
    add(h, b, fields, sizeof fields);
    add_word(h, b, twice ? 1023 : 127, 4);
}

static uint64_t count_of(const se3di_hdf5_shape *shape)
{
    uint64_t count = 1;
    for (int k = 0; k < shape->rank; ++k) {
        count *= shape->dims[k];
    }
    return count;
}

void se3di_hdf5_add_attribute(se3di_hdf5 *h, size_t node, const char *name,
                              const se3di_hdf5_shape *shape, const void *values)
{
    const size_t length = strlen(name) + 1;
    se3di_iobytes body = {NULL, 0, 0}, type = {NULL, 0, 0}, space = {NULL, 0, 0};
    add_datatype(h, &type, shape);
    add_dataspace(h, &space, shape);
    add_word(h, &body, 3, 1);
    add_word(h, &body, 0, 1);
    add_word(h, &body, length, 2);
    add_word(h, &body, type.count, 2);
    add_word(h, &body, space.count, 2);
    add_word(h, &body, 1, 1); /* the name is UTF-8 */
    add(h, &body, name, length);
    add(h, &body, type.data, type.count);
    add(h, &body, space.data, space.count);
    if (shape->type == SE3DI_HDF5_TEXT) {
        add(h, &body, values, shape->text_size);
    }
    for (uint64_t k = 0; shape->type != SE3DI_HDF5_TEXT && k < count_of(shape); ++k) {
        unsigned char value[8];
        se3di_hdf5_put_value(value, shape->type, ((const double *)values)[k]);
        add(h, &body, value, se3di_hdf5_size_of(shape));
    }
    if (h->failure == 0) {
        add_message(h, &h->nodes[node].attributes, MESSAGE_ATTRIBUTE, &body);
    }
}

/* --- groups and arrays --- */

static void write_at(se3di_hdf5 *h, uint64_t place, const void *data, size_t size)
{
    if (h->failure != 0 || size == 0) {
        return;
    }
    errno = 0;
    if (place != h->at && !se3di_file_seek(h->file, place)) {
        fail(h, errno);
    } else if (fwrite(data, 1, size, h->file) != size) {
        fail(h, errno);
    }
    h->at = place + size;
}

static size_t add_node(se3di_hdf5 *h, size_t parent, const char *name)
{
    struct se3di_hdf5_node *grown =
        h->failure ? NULL
                   : se3di_iopool_grow(&h->pool, h->nodes, h->count, &h->capacity, sizeof *grown);
    const char *copy = grown ? se3di_iopool_copy(&h->pool, name, strlen(name)) : NULL;
    if (!copy) {
        fail(h, ENOMEM);
        return 0;
    }
    h->nodes = grown;
    h->nodes[h->count] = (struct se3di_hdf5_node){.name = copy, .parent = parent, .data = NOWHERE};
    return h->count++;
}

/* --- arrays in pieces --- */

/* How much of the first dimension is a piece; 0: the array is in one. */
static void choose_piece(se3di_hdf5 *h, struct se3di_hdf5_node *n)
{
    if (h->compression == 0 || n->size < PIECES_LEAST || n->shape.rank == 0) {
        n->shape.piece = 0;
        return;
    }
    const uint64_t row = n->size / n->shape.dims[0];
    uint64_t rows = n->shape.piece > 0 ? n->shape.piece : row < PIECE_BYTES ? PIECE_BYTES / row : 1;
    rows = rows < n->shape.dims[0] ? rows : n->shape.dims[0];
    if (row > PIECE_MOST || rows > PIECE_MOST / row) {
        fail(h, EOVERFLOW);
        return;
    }
    n->shape.piece = rows;
    n->piece_size = rows * row;
}

/* First bytes of all values, then second ones, ...: they are alike. */
static const unsigned char *shuffle(se3di_hdf5 *h, const se3di_iobytes *b, size_t width)
{
    if (width == 1) {
        return b->data;
    }
    if (b->count > h->shuffled_size) {
        h->shuffled = se3di_iopool_alloc(&h->pool, b->count);
        h->shuffled_size = h->shuffled ? b->count : 0;
    }
    if (!h->shuffled) {
        fail(h, ENOMEM);
        return NULL;
    }
    const size_t count = b->count / width;
    for (size_t k = 0; k < width; ++k) {
        for (size_t i = 0; i < count; ++i) {
            h->shuffled[k * count + i] = b->data[i * width + k];
        }
    }
    return h->shuffled;
}

static void put_piece(se3di_hdf5 *h, struct se3di_hdf5_node *n)
{
    size_t made = 0;
    const unsigned char *data = shuffle(h, &n->waiting, se3di_hdf5_size_of(&n->shape));
    data = data ? se3di_deflate_block(&h->deflate, data, n->waiting.count, &made) : NULL;
    piece *grown = data ? se3di_iopool_grow(&h->pool, n->pieces, n->piece_count, &n->piece_capacity,
                                            sizeof *grown)
                        : NULL;
    if (!grown) {
        fail(h, data ? ENOMEM : errno);
        return;
    }
    n->pieces = grown;
    n->pieces[n->piece_count] = (piece){h->end, n->piece_count, (uint32_t)made, 0};
    ++n->piece_count;
    write_at(h, h->end, data, made);
    h->end += made;
    n->waiting.count = 0;
}

static void write_pieces(se3di_hdf5 *h, struct se3di_hdf5_node *n, const unsigned char *data,
                         size_t size)
{
    while (size > 0 && h->failure == 0) {
        const size_t lacks = (size_t)n->piece_size - n->waiting.count;
        const size_t now = size < lacks ? size : lacks;
        add(h, &n->waiting, data, now);
        if (n->waiting.count == n->piece_size) {
            put_piece(h, n);
        }
        data += now;
        size -= now;
    }
}

/* The last piece is as long as the others: filled up with zeros. */
static void complete_pieces(se3di_hdf5 *h, struct se3di_hdf5_node *n)
{
    static const unsigned char zeros[64] = {0};
    while (n->waiting.count > 0 && h->failure == 0) {
        const size_t lacks = (size_t)n->piece_size - n->waiting.count;
        write_pieces(h, n, zeros, lacks < sizeof zeros ? lacks : sizeof zeros);
    }
}

/* The beginning of piece `first`, and how long it is. */
static void add_key(se3di_hdf5 *h, se3di_iobytes *b, const struct se3di_hdf5_node *n,
                    uint64_t first, uint32_t size)
{
    add_word(h, b, size, 4);
    add_word(h, b, 0, 4); /* all filters were used */
    add_word(h, b, first * n->shape.piece, 8);
    for (int k = 1; k <= n->shape.rank; ++k) { /* the last one is within a value */
        add_word(h, b, 0, 8);
    }
}

/* One node of the tree at h->end, of `count` entries; the next one begins with piece `next`. */
static void write_node(se3di_hdf5 *h, const struct se3di_hdf5_node *n, const se3di_iobytes *head,
                       const piece *entries, size_t count, uint64_t next)
{
    const size_t key = 8 + 8 * ((size_t)n->shape.rank + 1);
    const size_t size = TREE_HEAD + TREE_ENTRIES * 8 + (TREE_ENTRIES + 1) * key;
    se3di_iobytes b = {NULL, 0, 0};
    add(h, &b, head->data, head->count);
    for (size_t k = 0; k < count; ++k) {
        add_key(h, &b, n, entries[k].first, entries[k].size);
        add_word(h, &b, entries[k].address, 8);
    }
    add_key(h, &b, n, next, 0);
    while (b.count < size && h->failure == 0) {
        add_word(h, &b, 0, 8);
    }
    write_at(h, h->end, b.data, b.count);
    h->end += b.count;
}

/* The nodes of one level, one after the other; @return how many, which are the entries of the next
 * level. */
static size_t write_level(se3di_hdf5 *h, const struct se3di_hdf5_node *n, int level, piece *entries,
                          size_t count)
{
    const size_t nodes = (count + TREE_ENTRIES - 1) / TREE_ENTRIES;
    uint64_t before = NOWHERE;
    for (size_t k = 0; k < nodes && h->failure == 0; ++k) {
        const size_t first = k * TREE_ENTRIES, rest = count - first;
        const size_t here = rest < TREE_ENTRIES ? rest : TREE_ENTRIES;
        const uint64_t next = first + here < count ? entries[first + here].first : n->piece_count;
        const uint64_t address = h->end;
        const size_t key = 8 + 8 * ((size_t)n->shape.rank + 1);
        const uint64_t size = TREE_HEAD + TREE_ENTRIES * 8 + (TREE_ENTRIES + 1) * key;
        se3di_iobytes head = {NULL, 0, 0};
        add(h, &head, "TREE\1", 5); /* of pieces */
        add_word(h, &head, (uint64_t)level, 1);
        add_word(h, &head, here, 2);
        add_word(h, &head, before, 8);
        add_word(h, &head, k + 1 < nodes ? address + size : NOWHERE, 8);
        write_node(h, n, &head, entries + first, here, next);
        entries[k] = (piece){address, entries[first].first, entries[first].size, 0};
        before = address;
    }
    return nodes;
}

static void align_end(se3di_hdf5 *h)
{
    h->end = (h->end + ALIGN - 1) / ALIGN * ALIGN;
}

static void write_tree(se3di_hdf5 *h, struct se3di_hdf5_node *n)
{
    size_t count = n->piece_count;
    align_end(h);
    for (int level = 0; h->failure == 0 && (level == 0 || count > 1); ++level) {
        count = write_level(h, n, level, n->pieces, count);
    }
    if (h->failure == 0) {
        n->data = n->pieces[0].address;
    }
}

bool se3di_hdf5_open(se3di_hdf5 *h, const se3d_allocator *allocator, const char *path,
                     int compression)
{
    memset(h, 0, sizeof *h);
    se3di_iopool_init(&h->pool, allocator);
    h->path = path;
    h->end = SUPERBLOCK;
    h->compression = compression;
    if (compression > 0 && !se3di_deflate_open(&h->deflate, &h->pool, compression)) {
        const int why = errno;
        se3di_iopool_destroy(&h->pool);
        errno = why;
        return false;
    }
    h->file = se3di_partial_open(path);
    if (!h->file) {
        const int why = errno;
        se3di_deflate_close(&h->deflate);
        se3di_iopool_destroy(&h->pool);
        errno = why;
        return false;
    }
    static const unsigned char nothing[SUPERBLOCK] = {0};
    write_at(h, 0, nothing, sizeof nothing);
    add_node(h, 0, "");
    if (h->failure != 0) {
        (void)se3di_hdf5_close(h);
        return false;
    }
    h->nodes[0].is_group = true;
    return true;
}

size_t se3di_hdf5_add_group(se3di_hdf5 *h, size_t group, const char *name)
{
    const size_t node = add_node(h, group, name);
    if (node > 0) {
        h->nodes[node].is_group = true;
    }
    return node;
}

size_t se3di_hdf5_add_array(se3di_hdf5 *h, size_t group, const char *name,
                            const se3di_hdf5_shape *shape)
{
    const size_t node = add_node(h, group, name);
    if (node > 0) {
        struct se3di_hdf5_node *n = &h->nodes[node];
        n->shape = *shape;
        n->size = count_of(shape) * se3di_hdf5_size_of(shape);
        choose_piece(h, n);
        if (n->size > 0 && n->piece_size == 0) {
            n->data = h->end;
            h->end += n->size;
            align_end(h);
        }
    }
    return node;
}

void se3di_hdf5_write(se3di_hdf5 *h, size_t array, uint64_t first, const void *data, size_t size)
{
    if (h->failure != 0 || array == 0) {
        return;
    }
    struct se3di_hdf5_node *n = &h->nodes[array];
    if (first != n->written || size > n->size - first) {
        fail(h, EIO);
    } else if (n->piece_size == 0) {
        write_at(h, n->data + first, data, size);
    } else {
        write_pieces(h, n, data, size);
    }
    n->written += size;
}

/* Values that were never written would be what the place held before. */
static void check_written(se3di_hdf5 *h)
{
    for (size_t k = 1; k < h->count; ++k) {
        if (!h->nodes[k].is_group && h->nodes[k].written != h->nodes[k].size) {
            fail(h, EIO);
        }
    }
}

/* --- headers --- */

static void add_filter(se3di_hdf5 *h, se3di_iobytes *b, int id, uint64_t value)
{
    add_word(h, b, (uint64_t)id, 2);
    add_word(h, b, 0, 2); /* it must be there */
    add_word(h, b, 1, 2); /* one number says how */
    add_word(h, b, value, 4);
}

static void put_filters(se3di_hdf5 *h, se3di_iobytes *to, const struct se3di_hdf5_node *n)
{
    const size_t width = se3di_hdf5_size_of(&n->shape);
    se3di_iobytes filters = {NULL, 0, 0};
    add_word(h, &filters, 2, 1); /* version */
    add_word(h, &filters, width > 1 ? 2 : 1, 1);
    if (width > 1) {
        add_filter(h, &filters, FILTER_SHUFFLE, width);
    }
    add_filter(h, &filters, FILTER_DEFLATE, (uint64_t)h->compression);
    add_message(h, to, MESSAGE_FILTERS, &filters);
}

static void put_layout(se3di_hdf5 *h, se3di_iobytes *to, const struct se3di_hdf5_node *n)
{
    se3di_iobytes layout = {NULL, 0, 0};
    add_word(h, &layout, 3, 1); /* version */
    if (n->piece_size == 0) {
        add_word(h, &layout, 1, 1); /* in one piece */
        add_word(h, &layout, n->data, 8);
        add_word(h, &layout, n->size, 8);
    } else {
        add_word(h, &layout, 2, 1); /* in pieces, of so much along each dimension and in a value */
        add_word(h, &layout, (uint64_t)n->shape.rank + 1, 1);
        add_word(h, &layout, n->data, 8);
        for (int k = 0; k < n->shape.rank; ++k) {
            add_word(h, &layout, k == 0 ? n->shape.piece : n->shape.dims[k], 4);
        }
        add_word(h, &layout, se3di_hdf5_size_of(&n->shape), 4);
    }
    add_message(h, to, MESSAGE_LAYOUT, &layout);
}

static void put_array(se3di_hdf5 *h, se3di_iobytes *to, const struct se3di_hdf5_node *n)
{
    se3di_iobytes space = {NULL, 0, 0}, type = {NULL, 0, 0}, fill = {NULL, 0, 0};
    add_dataspace(h, &space, &n->shape);
    add_datatype(h, &type, &n->shape);
    add_word(h, &fill, 3, 1);                               /* version */
    add_word(h, &fill, n->piece_size > 0 ? 0x0b : 0x0a, 1); /* no value, place when it is written */
    add_message(h, to, MESSAGE_DATASPACE, &space);
    add_message(h, to, MESSAGE_DATATYPE, &type);
    add_message(h, to, MESSAGE_FILL, &fill);
    if (n->piece_size > 0) {
        put_filters(h, to, n);
    }
    put_layout(h, to, n);
}

/* A child of a group: the order of creation is kept. */
static void put_link(se3di_hdf5 *h, se3di_iobytes *to, const struct se3di_hdf5_node *child,
                     uint64_t order)
{
    se3di_iobytes link = {NULL, 0, 0};
    const size_t length = strlen(child->name);
    add_word(h, &link, 1, 1);    /* version */
    add_word(h, &link, 0x15, 1); /* 2 bytes for the length, order and character set are there */
    add_word(h, &link, order, 8);
    add_word(h, &link, 1, 1); /* UTF-8 */
    add_word(h, &link, length, 2);
    add(h, &link, child->name, length);
    add_word(h, &link, child->header, 8);
    add_message(h, to, MESSAGE_LINK, &link);
}

static void put_group(se3di_hdf5 *h, se3di_iobytes *to, size_t group)
{
    se3di_iobytes info = {NULL, 0, 0}, nothing = {NULL, 0, 0};
    uint64_t order = 0;
    add_word(h, &info, 0, 1); /* version */
    add_word(h, &info, 1, 1); /* the order is kept */
    add_word(h, &info, h->nodes[group].children, 8);
    add_word(h, &info, NOWHERE, 8); /* links stand in the header */
    add_word(h, &info, NOWHERE, 8);
    add_word(h, &nothing, 0, 2);
    add_message(h, to, MESSAGE_LINK_INFO, &info);
    add_message(h, to, MESSAGE_GROUP_INFO, &nothing);
    for (size_t k = group + 1; k < h->count; ++k) {
        if (h->nodes[k].parent == group) {
            put_link(h, to, &h->nodes[k], order++);
        }
    }
}

static void write_header(se3di_hdf5 *h, size_t node)
{
    struct se3di_hdf5_node *n = &h->nodes[node];
    se3di_iobytes messages = {NULL, 0, 0}, all = {NULL, 0, 0};
    if (n->is_group) {
        put_group(h, &messages, node);
    } else {
        put_array(h, &messages, n);
    }
    add(h, &messages, n->attributes.data, n->attributes.count);
    add(h, &all, "OHDR\2\2", 6); /* version 2, 4 bytes for the size */
    add_word(h, &all, messages.count, 4);
    add(h, &all, messages.data, messages.count);
    if (h->failure != 0) {
        return;
    }
    add_word(h, &all, checksum(all.data, all.count), 4);
    n->header = h->end;
    h->end += (all.count + ALIGN - 1) / ALIGN * ALIGN;
    write_at(h, n->header, all.data, all.count);
}

static void write_superblock(se3di_hdf5 *h)
{
    unsigned char block[SUPERBLOCK] = "\211HDF\r\n\032\n\2\10\10"; /* version 2, sizes of words */
    se3di_little_put(block + 12, 0, 8);
    se3di_little_put(block + 20, NOWHERE, 8);
    se3di_little_put(block + 28, h->end, 8);
    se3di_little_put(block + 36, h->nodes[0].header, 8);
    se3di_little_put(block + 44, checksum(block, 44), 4);
    write_at(h, 0, block, sizeof block);
}

/* The file is as long as the superblock says: the last header may be followed by filling. */
static void fill_end(se3di_hdf5 *h)
{
    static const unsigned char zeros[ALIGN] = {0};
    if (h->at < h->end) {
        write_at(h, h->at, zeros, (size_t)(h->end - h->at));
    }
}

bool se3di_hdf5_close(se3di_hdf5 *h)
{
    check_written(h);
    for (size_t k = 1; k < h->count && h->failure == 0; ++k) {
        ++h->nodes[h->nodes[k].parent].children;
    }
    for (size_t k = 1; k < h->count && h->failure == 0; ++k) {
        if (h->nodes[k].piece_size > 0) {
            complete_pieces(h, &h->nodes[k]);
            write_tree(h, &h->nodes[k]);
        }
    }
    for (size_t k = h->count; k-- > 0 && h->failure == 0;) { /* children come after their group */
        write_header(h, k);
    }
    fill_end(h);
    if (h->failure == 0) {
        write_superblock(h);
    }
    int why = h->failure;
    if (why != 0) {
        se3di_partial_abandon(h->file, h->path);
    } else if (!se3di_partial_close(h->file, h->path)) {
        why = errno ? errno : EIO;
    }
    se3di_deflate_close(&h->deflate);
    se3di_iopool_destroy(&h->pool);
    h->file = NULL;
    errno = why;
    return why == 0;
}
