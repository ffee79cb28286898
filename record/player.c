/* SPDX-License-Identifier: BSD-3-Clause */
#include "player.h"

#include <string.h>

#include "player_parts.h"
#include "se3d/se3d.h"

/* ---- Pieces of the thread that is played. ---- */

static score_piece *present(stage *s)
{
    return s->at == SCORE_NONE ? NULL : &s->score.pieces[s->at];
}

/* There is a present one. */
static void pass(stage *s)
{
    score_piece *p = &s->score.pieces[s->at];
    p->is_done = 1;
    s->at = p->next;
}

/* Go to what ends a call that has begun, past all that stands in it. */
static void pass_to_return(stage *s)
{
    for (size_t depth = 0; present(s); pass(s)) {
        if (present(s)->kind == FORMAT_CALL) {
            ++depth;
        } else if (present(s)->kind == FORMAT_RETURN && depth-- == 0) {
            return;
        }
    }
}

/* Answers of callbacks that several threads may call stand anywhere. */
static void pass_answers(stage *s)
{
    while (present(s) && (present(s)->kind == FORMAT_ANSWER || present(s)->kind == FORMAT_FAIL)) {
        pass(s);
    }
}

static bytes_reader reader_of(const score_piece *p)
{
    return (bytes_reader){p->content, p->content + p->size, 0};
}

/* ---- Callbacks. ---- */

/* One output of a callback, as it was given when recorded. */
static int give_output(stage *s, const layout_item *item, unsigned char *to, size_t count,
                       bytes_reader *r)
{
    const uint64_t then = bytes_get_u64(r);
    int is_good = then == count;
    if (item->kind == LAYOUT_STRUCT) {
        bytes_get(r, 12); /* its size, and how many members follow */
        for (size_t k = 0; k < item->of->member_count; ++k) {
            const layout_item *member = &item->of->members[k];
            const unsigned char *from = bytes_get(r, member->size * member->count);
            memcpy(to + member->offset, from ? from : to, from ? member->size * member->count : 0);
        }
    } else {
        is_good &= bytes_get_u8(r) == 0 && item->kind == LAYOUT_BYTES;
        const unsigned char *from = is_good ? bytes_get(r, layout_times(count, item->size)) : NULL;
        memcpy(to, from ? from : to, from ? count * item->size : 0);
    }
    return r->failed || !is_good
               ? stage_end(s, PLAYER_MALFORMED, "the answer of a callback is damaged")
               : 0;
}

/* Give what an ANSWER gave. */
static int give(stage_callback *c, size_t piece, void *const *arguments, void *result)
{
    c->of->walk.definition = c->definition; /* calls within may have left another */
    bytes_reader r = reader_of(&c->of->score.pieces[piece]);
    bytes_get(&r, 12);
    if (result) {
        const unsigned char *from = bytes_get(&r, c->type->result->size);
        memcpy(result, from ? from : result, from ? c->type->result->size : 0);
    }
    for (size_t k = 0; k < c->type->parameter_count; ++k) {
        const layout_item *item = &c->type->parameters[k];
        unsigned char *to = NULL;
        if (item->way != LAYOUT_OUT) {
            continue;
        }
        memcpy(&to, arguments[k], sizeof to);
        if ((bytes_get_u8(&r) != 0) != (to != NULL)) {
            return stage_end(c->of, PLAYER_MALFORMED, "a callback was asked for other outputs");
        }
        if (to &&
            give_output(c->of, item, to, layout_count(&c->of->walk, item, arguments, 0), &r) != 0) {
            return -1;
        }
    }
    return 0;
}

static void refuse(const stage_callback *c, void *result)
{
    if (result) {
        const int32_t failure = SE3D_ERR_CALLBACK; /* of an interrupt: stop */
        memcpy(result, &failure, sizeof failure);
    }
    (void)c;
}

/* The answer to the same question, whenever it was asked; in a free play else the next one. */
static size_t find_answer(stage_callback *c, uint64_t hash)
{
    stage *s = c->of;
    const uint64_t *same = map_find(&s->score.answers, score_key(c->id, hash));
    if (same || !s->options->is_free) {
        return same ? (size_t)*same : SCORE_NONE;
    }
    const uint64_t *first = map_find(&s->score.first, c->id);
    if (c->at == SCORE_NONE) {
        c->at = first ? (size_t)*first : SCORE_NONE;
    } else if (s->score.pieces[c->at].later != SCORE_NONE) {
        c->at = s->score.pieces[c->at].later;
    }
    return c->at;
}

/* Make the calls that the callback made. @return the piece that holds its answer, SCORE_NONE */
static size_t make_calls_within(stage *s)
{
    size_t answer = SCORE_NONE;
    ++s->depth;
    while (present(s) && s->verdict == PLAYER_SAME && answer == SCORE_NONE) {
        const int kind = present(s)->kind;
        if (kind == FORMAT_CALL) {
            player_make_call(s, s->at);
        } else if (kind == FORMAT_ANSWER) {
            answer = s->at;
            pass(s);
        } else if (kind == FORMAT_NOTE || kind == FORMAT_HASH || kind == FORMAT_FAIL) {
            pass(s);
        } else {
            break;
        }
    }
    --s->depth;
    return answer;
}

/* @return the piece that holds the answer, SCORE_NONE: there is none */
static size_t answer_in_order(stage_callback *c, uint64_t hash)
{
    stage *s = c->of;
    const score_piece *p = present(s);
    if (p && p->kind == FORMAT_CALLBACK) {
        bytes_reader r = reader_of(p);
        const uint32_t id = bytes_get_u32(&r);
        if (id == c->id && bytes_get_u64(&r) == hash && !r.failed) {
            pass(s);
            const size_t piece = make_calls_within(s);
            if (piece == SCORE_NONE && s->options->is_free) {
                return find_answer(c, hash);
            }
            if (piece == SCORE_NONE) {
                s->report->ends_within = 1;
                stage_end(s, PLAYER_DIFFERS, "its callback %u (%s) did not return when recorded",
                          (unsigned)c->id, c->type->name);
            }
            return piece;
        }
    }
    if (!s->options->is_free) {
        const int is_same = p && p->kind == FORMAT_CALLBACK;
        stage_end(s, PLAYER_DIFFERS,
                  is_same ? "its callback %u (%s) is called with other arguments"
                          : "its callback %u (%s) is called once more",
                  (unsigned)c->id, c->type->name);
        return SCORE_NONE;
    }
    return find_answer(c, hash);
}

static int is_interrupted(stage *s, const stage_callback *c, void *result)
{
    const int32_t stop = s->options->interrupts > 0 && ++s->interrupts > s->options->interrupts;
    if (stop || c->id == FORMAT_UNKNOWN) {
        memcpy(result, &stop, sizeof stop);
    }
    return stop || c->id == FORMAT_UNKNOWN;
}

static void answer(stage_callback *c, void *const *arguments, void *result)
{
    stage *s = c->of;
    bytes given = {0};
    s->walk.definition = c->definition;
    layout_write_all(&s->walk, c->type, arguments, LAYOUT_IN, &given);
    const uint64_t hash = bytes_hash(given.data, given.size);
    bytes_free(&given);
    ++s->report->callbacks;
    const size_t piece =
        c->type->is_concurrent || s->is_quiet ? find_answer(c, hash) : answer_in_order(c, hash);
    if (s->verdict == PLAYER_SAME && piece == SCORE_NONE && !s->options->is_free) {
        stage_end(s, PLAYER_DIFFERS, "its callback %u (%s) is called with other arguments",
                  (unsigned)c->id, c->type->name);
    }
    if (s->verdict != PLAYER_SAME || piece == SCORE_NONE ||
        give(c, piece, arguments, result) != 0) {
        refuse(c, result);
    }
}

void player_answer(void *ctx, void *const *arguments, void *result)
{
    stage_callback *c = ctx;
    stage *s = c->of;
    if (c->type->is_concurrent) {
        while (atomic_flag_test_and_set(&s->locked)) {
        }
        answer(c, arguments, result);
        atomic_flag_clear(&s->locked);
    } else if (strcmp(c->type->name, "se3d_interrupt") != 0 || !is_interrupted(s, c, result)) {
        answer(c, arguments, result);
    }
}

/* ---- Calls. ---- */

/* Whether a call within a callback destroys what is at work, which the library refuses. */
static int is_refused(stage *s, const layout_function *f, const stage_object *o)
{
    const se3d_system *system = NULL;
    if (strcmp(f->name, "se3d_system_destroy") == 0) {
        system = o->pointer;
    } else if (o->parent > 0 && s->objects[o->parent - 1].lives) {
        const stage_object *parent = &s->objects[o->parent - 1];
        system = strcmp(layout_owners[parent->kind], "se3d_system") == 0 ? parent->pointer : NULL;
    }
    return s->depth > 0 && (!system || se3d_system_is_busy(system));
}

/* @return whether the call is to be made: what it destroys no longer lives then */
static int prepare_destroy(stage *s, const layout_function *f, const player_arguments *a)
{
    void *pointer;
    if (!f->destroys) {
        return 1;
    }
    memcpy(&pointer, a->slots[0], sizeof pointer);
    stage_object *o = stage_find_pointer(s, f->parameters[0].number, pointer);
    if (!o) {
        return !pointer;
    }
    if (is_refused(s, f, o)) {
        return strcmp(f->name, "se3d_batch_destroy") != 0;
    }
    stage_kill(s, o);
    return 1;
}

/* What the call makes belongs to the first object that it is given. */
static size_t parent_of(stage *s, const layout_function *f, const player_arguments *a)
{
    void *pointer;
    if (f->parameter_count == 0 || f->parameters[0].kind != LAYOUT_OWNER ||
        f->parameters[0].pointer) {
        return 0;
    }
    memcpy(&pointer, a->slots[0], sizeof pointer);
    return stage_index(s, stage_find_pointer(s, f->parameters[0].number, pointer));
}

static void tell(stage *s, const layout_function *f, const player_arguments *a, int is_after)
{
    int32_t status = 0;
    if (f->has_status) {
        memcpy(&status, a->result, sizeof status);
    }
    if (s->options->told) {
        s->options->told(s->options->ctx, s->number, f->name, is_after, (int)status);
    }
}

/* Make a call whose arguments are there, and compare. */
static int make(stage *s, const layout_function *f, player_arguments *a)
{
    s->parent = parent_of(s, f, a);
    const size_t parent = s->parent;
    tell(s, f, a, 0);
    if (prepare_destroy(s, f, a)) {
        player_calls[f - layout_functions](a->at, a->result);
    }
    tell(s, f, a, 1);
    s->parent = parent;
    pass_answers(s);
    if (s->options->is_free || s->verdict != PLAYER_SAME) {
        pass_to_return(s);
    }
    bytes_reader r = {0};
    const score_piece *p = present(s);
    if (!p) {
        s->report->ends_within = 1;
        return player_bind_all(s, f, a);
    }
    if (p->kind != FORMAT_RETURN) {
        player_bind_all(s, f, a);
        return stage_end(s, PLAYER_DIFFERS,
                         p->kind == FORMAT_CALLBACK
                             ? "it called a callback more often when recorded"
                             : "the recording is damaged here");
    }
    r = reader_of(p);
    pass(s);
    return player_compare(s, f, a, &r);
}

int player_make_call(stage *s, size_t piece)
{
    bytes_reader r = reader_of(&s->score.pieces[piece]);
    const uint32_t number = bytes_get_u32(&r);
    stage_block *outer = s->part;
    player_arguments a;
    s->at = piece;
    pass(s);
    ++s->report->calls;
    if (r.failed || number >= s->score.function_count ||
        s->score.functions[number] >= layout_function_count) {
        return stage_end(s, PLAYER_MALFORMED, "it is a function that this library does not have");
    }
    const layout_function *f = &layout_functions[s->score.functions[number]];
    const char *outer_name = s->name;
    const size_t outer_number = s->number;
    s->name = s->report->name = f->name;
    s->number = s->report->calls;
    s->part = NULL;
    int result = player_read_arguments(s, f, &a, &r);
    if (result == 0 && s->options->allows && !s->options->allows(s->options->ctx, f->name, a.at)) {
        s->is_missing = 1;
        result = -1;
    }
    if (result == 0) {
        result = make(s, f, &a);
    } else if (s->is_missing && s->verdict == PLAYER_SAME) {
        ++s->report->left_out;
        pass_to_return(s);
        if (present(s)) {
            pass(s);
        }
        result = 0;
    }
    stage_release(&s->part);
    s->part = outer;
    s->name = outer_name;
    s->number = outer_number;
    return result;
}

/* A system is about to be destroyed. */
static void compare_hash(stage *s, const score_piece *p)
{
    bytes_reader r = reader_of(p);
    const uint32_t id = bytes_get_u32(&r);
    const uint64_t then = bytes_get_u64(&r);
    const stage_object *o = stage_find(s, id);
    if (s->options->is_free || r.failed || !o || !o->lives ||
        strcmp(layout_owners[o->kind], "se3d_system") != 0) {
        return;
    }
    s->is_quiet = 1;
    const uint64_t now = se3d_system_hash(o->pointer);
    s->is_quiet = 0;
    ++s->report->hashes;
    if (now != then) {
        stage_end(s, PLAYER_DIFFERS,
                  "the state of system %u has the hash %016llx, and %016llx when recorded",
                  (unsigned)id, (unsigned long long)now, (unsigned long long)then);
    }
}

player_verdict player_play(const unsigned char *data, size_t size, const player_options *options,
                           player_report *report)
{
    stage s;
    memset(report, 0, sizeof *report);
    stage_init(&s, options, report);
    if (score_read(&s.score, data, size) != 0) {
        stage_end(&s, PLAYER_MALFORMED, "%s", s.score.message);
    }
    for (size_t k = 0; k < s.score.count && s.verdict == PLAYER_SAME; ++k) {
        const score_piece *p = &s.score.pieces[k];
        if (!p->is_done && p->kind == FORMAT_CALL) {
            player_make_call(&s, k);
        } else if (!p->is_done && p->kind == FORMAT_HASH) {
            compare_hash(&s, p);
        }
    }
    report->ends_within |= s.score.is_cut;
    const player_verdict verdict = s.verdict;
    stage_clear(&s);
    return verdict;
}
