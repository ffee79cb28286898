/* SPDX-License-Identifier: BSD-3-Clause */
#include "score.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"

void score_free(score *s)
{
    free(s->pieces);
    free(s->functions);
    map_free(&s->answers);
    map_free(&s->failures);
    map_free(&s->first);
    memset(s, 0, sizeof *s);
}

uint64_t score_key(uint32_t callback, uint64_t hash)
{
    return hash ^ ((uint64_t)callback * 0x9e3779b97f4a7c15u);
}

static int fail(score *s, const char *why)
{
    snprintf(s->message, sizeof s->message, "%s", why);
    return -1;
}

static int read_head(score *s, bytes_reader *r)
{
    const unsigned char *magic = bytes_get(r, 8);
    if (!magic || memcmp(magic, FORMAT_MAGIC, 8) != 0) {
        return fail(s, "it is no recording: it does not begin with " FORMAT_MAGIC);
    }
    bytes_get(r, bytes_get_u32(r)); /* the version */
    s->function_count = bytes_get_u32(r);
    if (r->failed || s->function_count > (size_t)(r->end - r->at) / 4) {
        return fail(s, "its head is cut");
    }
    s->functions = calloc(s->function_count + 1, sizeof *s->functions);
    if (!s->functions) {
        return fail(s, "out of memory");
    }
    for (size_t k = 0; k < s->function_count; ++k) {
        char name[128] = "";
        const uint32_t length = bytes_get_u32(r);
        const unsigned char *text = bytes_get(r, length);
        if (text && length < sizeof name) {
            memcpy(name, text, length);
        }
        s->functions[k] = layout_find(name);
    }
    return r->failed ? fail(s, "its head is cut") : 0;
}

static size_t count_pieces(bytes_reader r)
{
    size_t count = 0;
    while (!r.failed && r.at < r.end) {
        const uint32_t size = bytes_get_u32(&r);
        bytes_get(&r, FORMAT_PIECE_HEAD - 4);
        bytes_get(&r, size);
        count += !r.failed;
    }
    return count;
}

/* Find an ANSWER again by what the callback was given, and one after the other. */
static int list_answer(score *s, size_t k, map *last)
{
    bytes_reader r = {s->pieces[k].content, s->pieces[k].content + s->pieces[k].size, 0};
    const uint32_t id = bytes_get_u32(&r);
    const uint64_t key = score_key(id, bytes_get_u64(&r));
    const uint64_t *before = map_find(last, id);
    if (r.failed) {
        return fail(s, "an answer is too short");
    }
    if (before) {
        s->pieces[*before].later = k;
    }
    if ((!before && map_set(&s->first, id, k) != 0) || map_set(last, id, k) != 0 ||
        (!map_find(&s->answers, key) && map_set(&s->answers, key, k) != 0)) {
        return fail(s, "out of memory");
    }
    return 0;
}

static int list_failure(score *s, const score_piece *p)
{
    bytes_reader r = {p->content, p->content + p->size, 0};
    const uint32_t id = bytes_get_u32(&r);
    return map_set(&s->failures, score_key(id, bytes_get_u64(&r)), 1) != 0
               ? fail(s, "out of memory")
               : 0;
}

static int link_pieces(score *s)
{
    map threads = {0}, last = {0};
    int result = 0;
    for (size_t k = 0; k < s->count && result == 0; ++k) {
        score_piece *p = &s->pieces[k];
        const uint64_t *before = map_find(&threads, p->thread);
        if (before) {
            s->pieces[*before].next = k;
        }
        if (map_set(&threads, p->thread, k) != 0) {
            result = fail(s, "out of memory");
        } else if (p->kind == FORMAT_ANSWER) {
            result = list_answer(s, k, &last);
        } else if (p->kind == FORMAT_FAIL) {
            result = list_failure(s, p);
        } else if (p->kind < 0 || p->kind > FORMAT_HASH) {
            result = fail(s, "it has a piece of an unknown kind");
        }
    }
    map_free(&threads);
    map_free(&last);
    return result;
}

int score_read(score *s, const unsigned char *data, size_t size)
{
    bytes_reader r = {data, data + size, 0};
    memset(s, 0, sizeof *s);
    if (read_head(s, &r) != 0) {
        return -1;
    }
    s->count = count_pieces(r);
    s->pieces = calloc(s->count + 1, sizeof *s->pieces);
    if (!s->pieces) {
        return fail(s, "out of memory");
    }
    for (size_t k = 0; k < s->count; ++k) {
        score_piece *p = &s->pieces[k];
        p->size = bytes_get_u32(&r);
        p->thread = bytes_get_u32(&r);
        p->kind = (int)bytes_get_u8(&r);
        p->content = bytes_get(&r, p->size);
        p->next = p->later = SCORE_NONE;
    }
    s->is_cut = r.at < r.end;
    return link_pieces(s);
}
