/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d evaluate MODEL: Phi, nu, gamma and the Jacobian of every equation, at the state of the file.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "outcome.h"

enum { SLOTS_MAX = 16 };

/* All equations of one constraint. */
typedef struct rows {
    size_t count;  /* equations */
    size_t bodies; /* slots */
    double *memory;
    double *phi, *nu, *gamma_rp, *gamma_romega;
    double *phi_r[SLOTS_MAX];
    double *phi_p[SLOTS_MAX];
    double *phi_pi[SLOTS_MAX];
    const char *names[SLOTS_MAX];
} rows;

static int allocate(rows *e)
{
    const size_t n = e->count;
    e->memory = calloc(n * (4 + 10 * e->bodies) + 1, sizeof *e->memory);
    if (!e->memory) {
        return 0;
    }
    double *at = e->memory;
    e->phi = at;
    e->nu = at + n;
    e->gamma_rp = at + 2 * n;
    e->gamma_romega = at + 3 * n;
    at += 4 * n;
    for (size_t k = 0; k < e->bodies; ++k) {
        e->phi_r[k] = at;
        e->phi_p[k] = at + 3 * n;
        e->phi_pi[k] = at + 7 * n;
        at += 10 * n;
    }
    return 1;
}

static se3d_status evaluate(const se3d_system *system, se3d_constraint c, rows *e)
{
    memset(e, 0, sizeof *e);
    se3d_status status = se3d_constraint_count_equations(system, c, &e->count);
    if (status >= 0) {
        status = se3d_constraint_count_bodies(system, c, &e->bodies);
    }
    if (status < 0) {
        return status;
    }
    if (e->bodies > SLOTS_MAX || !allocate(e)) {
        return SE3D_ERR_NO_MEMORY;
    }
    status = se3d_constraint_eval(system, c, SE3D_FORMULATION_RP, e->phi, e->nu, e->gamma_rp);
    if (status >= 0) {
        status =
            se3d_constraint_eval(system, c, SE3D_FORMULATION_ROMEGA, NULL, NULL, e->gamma_romega);
    }
    for (size_t k = 0; k < e->bodies && status >= 0; ++k) {
        se3d_body body;
        status = se3d_constraint_eval_jacobian(system, c, SE3D_FORMULATION_RP, k, e->phi_r[k],
                                               e->phi_p[k]);
        if (status >= 0) {
            status = se3d_constraint_eval_jacobian(system, c, SE3D_FORMULATION_ROMEGA, k, NULL,
                                                   e->phi_pi[k]);
        }
        if (status >= 0) {
            status = se3d_constraint_get_body(system, c, k, &body);
        }
        if (status >= 0) {
            status = se3d_body_get_name(system, body, &e->names[k]);
        }
    }
    return status;
}

static const char *slot_name(size_t slot, char text[24])
{
    snprintf(text, 24, "%zu", slot + 1);
    return slot == 0 ? "i" : slot == 1 ? "j" : text;
}

static void csv_put_numbers(const double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        printf(",%.17g", values[k]);
    }
}

static void csv_put_header(size_t slots)
{
    char text[24];
    fputs("constraint,type,equation,phi,nu,gamma_rp,gamma_romega", stdout);
    for (size_t k = 0; k < slots; ++k) {
        const char *s = slot_name(k, text);
        printf(",body_%s,phi_r_%s.x,phi_r_%s.y,phi_r_%s.z", s, s, s, s);
        printf(",phi_p_%s.e0,phi_p_%s.e1,phi_p_%s.e2,phi_p_%s.e3", s, s, s, s);
        printf(",phi_pi_%s.x,phi_pi_%s.y,phi_pi_%s.z", s, s, s);
    }
    putchar('\n');
}

static void csv_put_empty_slots(size_t first, size_t slots)
{
    for (size_t k = first; k < slots; ++k) {
        fputs(",,,,,,,,,,,", stdout);
    }
    putchar('\n');
}

static void csv_put_equation(const rows *e, size_t k, size_t slots)
{
    printf(",%.17g,%.17g,%.17g,%.17g", e->phi[k], e->nu[k], e->gamma_rp[k], e->gamma_romega[k]);
    for (size_t b = 0; b < e->bodies; ++b) {
        printf(",%s", e->names[b]);
        csv_put_numbers(&e->phi_r[b][3 * k], 3);
        csv_put_numbers(&e->phi_p[b][4 * k], 4);
        csv_put_numbers(&e->phi_pi[b][3 * k], 3);
    }
    csv_put_empty_slots(e->bodies, slots);
}

static void table_put_numbers(const char *name, const double *values, size_t count)
{
    printf("    %-7s", name);
    for (size_t k = 0; k < count; ++k) {
        printf(" %14.8g", values[k]);
    }
    putchar('\n');
}

static void table_put_equation(const rows *e, size_t k)
{
    printf("    Phi %.10g, nu %.10g, gamma %.10g (rp) %.10g (romega)\n", e->phi[k], e->nu[k],
           e->gamma_rp[k], e->gamma_romega[k]);
    for (size_t b = 0; b < e->bodies; ++b) {
        char text[24];
        printf("   body %s, %s\n", slot_name(b, text), e->names[b]);
        table_put_numbers("Phi_r", &e->phi_r[b][3 * k], 3);
        table_put_numbers("Phi_p", &e->phi_p[b][4 * k], 4);
        table_put_numbers("Phi_pi", &e->phi_pi[b][3 * k], 3);
    }
}

static void json_put_numbers(const char *name, const double *values, size_t count)
{
    printf(", \"%s\": [", name);
    for (size_t k = 0; k < count; ++k) {
        fputs(k > 0 ? ", " : "", stdout);
        json_put_number(values[k]);
    }
    putchar(']');
}

static void json_put_value(const char *name, double value)
{
    printf(", \"%s\": ", name);
    json_put_number(value);
}

/* The first members of an equation; *separator goes before the next one. */
static void json_put_head(const char **separator, const char *constraint, const char *type,
                          const char *equation)
{
    printf("%s{\"constraint\": ", *separator);
    *separator = ", ";
    json_put_text(constraint);
    fputs(", \"type\": ", stdout);
    json_put_text(type);
    fputs(", \"equation\": ", stdout);
    json_put_text(equation);
}

static void json_put_body(const char *separator, const char *slot, const char *body)
{
    printf("%s{\"slot\": ", separator);
    json_put_text(slot);
    fputs(", \"body\": ", stdout);
    json_put_text(body);
}

static void json_put_equation(const rows *e, size_t k)
{
    json_put_value("phi", e->phi[k]);
    json_put_value("nu", e->nu[k]);
    json_put_value("gamma_rp", e->gamma_rp[k]);
    json_put_value("gamma_romega", e->gamma_romega[k]);
    fputs(", \"bodies\": [", stdout);
    for (size_t b = 0; b < e->bodies; ++b) {
        char text[24];
        json_put_body(b > 0 ? ", " : "", slot_name(b, text), e->names[b]);
        json_put_numbers("phi_r", &e->phi_r[b][3 * k], 3);
        json_put_numbers("phi_p", &e->phi_p[b][4 * k], 4);
        json_put_numbers("phi_pi", &e->phi_pi[b][3 * k], 3);
        putchar('}');
    }
    fputs("]}", stdout);
}

static se3d_status print_constraint(const options *o, const se3d_system *system, se3d_constraint c,
                                    size_t slots, const char **separator)
{
    rows e;
    const char *name = "";
    const char *type = "";
    se3d_status status = evaluate(system, c, &e);
    if (status >= 0) {
        status = se3d_constraint_get_name(system, c, &name);
    }
    if (status >= 0) {
        status = se3d_constraint_get_type(system, c, &type);
    }
    for (size_t k = 0; k < e.count && status >= 0; ++k) {
        const char *equation = "";
        status = se3d_constraint_get_equation_name(system, c, k, &equation);
        if (status < 0) {
            break;
        }
        if (o->json) {
            json_put_head(separator, name, type, equation);
            json_put_equation(&e, k);
        } else if (o->csv) {
            printf("%s,%s,%s", name, type, equation);
            csv_put_equation(&e, k, slots);
        } else {
            printf("%s (%s) %s\n", name, type, equation);
            table_put_equation(&e, k);
        }
    }
    free(e.memory);
    return status;
}

/* p.p - 1 = 0 with Phi_p = 2 p^T and gamma = -2 pdot.pdot = -w.w / 2, for unit p. */
static se3d_status print_norm(const options *o, const se3d_system *system, se3d_body body,
                              size_t slots, const char **separator)
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    const char *name = "";
    double p[4];
    double w[3];
    double row[4];
    int32_t fixed = 0;
    if (SE3D_FAILED(se3d_body_get_fixed(system, body, &fixed)) || fixed) {
        return SE3D_OK;
    }
    se3d_status status = se3d_body_get_orientation(system, body, p);
    if (status >= 0) {
        status = se3d_body_get_angular_velocity(system, body, w);
    }
    if (status >= 0) {
        status = se3d_body_get_name(system, body, &name);
    }
    if (status < 0) {
        return status;
    }
    const double phi = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3] - 1.0;
    const double gamma = 0.0 - 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) * (phi + 1.0);
    for (int k = 0; k < 4; ++k) {
        row[k] = 2.0 * p[k];
    }
    if (o->json) {
        json_put_head(separator, name, "normalization", "euler_norm");
        json_put_value("phi", phi);
        json_put_value("nu", 0.0);
        json_put_value("gamma_rp", gamma);
        fputs(", \"gamma_romega\": null, \"bodies\": [", stdout);
        json_put_body("", "i", name);
        json_put_numbers("phi_r", zero, 3);
        json_put_numbers("phi_p", row, 4);
        fputs(", \"phi_pi\": null}]}", stdout);
    } else if (o->csv) {
        printf("%s,normalization,euler_norm,%.17g,0,%.17g,,%s", name, phi, gamma, name);
        csv_put_numbers(zero, 3);
        csv_put_numbers(row, 4);
        fputs(",,,", stdout);
        csv_put_empty_slots(1, slots);
    } else {
        printf("%s (normalization, rp only) euler_norm\n", name);
        printf("    Phi %.10g, nu 0, gamma %.10g (rp)\n", phi, gamma);
        table_put_numbers("Phi_r", zero, 3);
        table_put_numbers("Phi_p", row, 4);
    }
    return SE3D_OK;
}

/* The largest number of bodies in a constraint, at least 2. */
static size_t count_slots(const se3d_system *system)
{
    size_t slots = 2;
    for (size_t k = 0; k < se3d_system_count_constraints(system); ++k) {
        se3d_constraint c;
        size_t bodies = 0;
        if (!SE3D_FAILED(se3d_system_get_constraint(system, k, &c)) &&
            !SE3D_FAILED(se3d_constraint_count_bodies(system, c, &bodies)) && bodies > slots) {
            slots = bodies;
        }
    }
    return slots;
}

static se3d_status print_all(const options *o, const se3d_system *system)
{
    const size_t slots = count_slots(system);
    const char *separator = "";
    se3d_status status = SE3D_OK;
    if (o->json) {
        fputs("{\"equations\": [", stdout);
    } else if (o->csv) {
        csv_put_header(slots);
    }
    for (size_t k = 0; k < se3d_system_count_constraints(system) && status >= 0; ++k) {
        se3d_constraint c;
        status = se3d_system_get_constraint(system, k, &c);
        if (status >= 0) {
            status = print_constraint(o, system, c, slots, &separator);
        }
    }
    for (size_t k = 0; k < se3d_system_count_bodies(system) && status >= 0; ++k) {
        se3d_body body;
        status = se3d_system_get_body(system, k, &body);
        if (status >= 0) {
            status = print_norm(o, system, body, slots, &separator);
        }
    }
    return status;
}

static void end_json(const options *o, const char *status, const char *message)
{
    if (o->json) {
        outcome_tell();
        printf("], \"status\": \"%s\", \"message\": ", status);
        json_put_text(message);
        fputs("}\n", stdout);
    }
}

static int evaluate_model(const options *o, se3d_model *model)
{
    se3d_system *system = se3d_model_get_system(model);
    if (o->json && o->csv) {
        complain("se3d evaluate: give --csv or --json, not both\n");
        return EXIT_USAGE;
    }
    if (o->time) {
        char *end = NULL;
        const double time = strtod(o->time, &end);
        if (end == o->time || *end || SE3D_FAILED(se3d_system_set_time(system, time))) {
            complain("se3d evaluate: --time is `%s`, must be a finite number\n", o->time);
            return EXIT_USAGE;
        }
    }
    const se3d_status status = print_all(o, system);
    if (status < 0) {
        const char *why = se3d_system_get_error(system);
        why = why[0] ? why : se3d_status_get_text(status);
        fflush(stdout);
        complain("%s: %s\n", o->model, why);
        end_json(o, "error", why);
        return EXIT_FAILED;
    }
    end_json(o, "done", "");
    return EXIT_DONE;
}

static int command_evaluate(int count, char *const *words)
{
    options o;
    se3d_model *model = NULL;
    int code = options_read(&o, &evaluate_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    se3d_model_options how = options_get_model(&o);
    how.mass_optional = 1;
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE) {
        code = evaluate_model(&o, model);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry evaluate_entry = {
    .name = "evaluate",
    .run = command_evaluate,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "print Phi, nu, gamma and the Jacobian of every constraint",
    .text = "Prints, for every equation of every constraint at the positions and "
            "velocities in the file: Phi, nu (Phi_q qdot = nu), gamma (Phi_q qddot = "
            "gamma) of both formulations, and the Jacobian with respect to position "
            "(Phi_r), Euler parameters (Phi_p, r-p formulation) and virtual rotation in "
            "the body frame (Phi_pi, r-omega) of each body. The last rows are p.p - 1 of "
            "every movable body, which belong to r-p only. Bodies need no mass here.",
    .options =
        (const command_option[]){
            COMMAND_OPTION_SET,
            {"--time", NULL, "T", "the time of the functions of time [s] (default 0)"},
            {"--csv", NULL, NULL,
             "one line an equation: constraint, type, equation, phi, nu, gamma_rp, gamma_romega, "
             "then for body i, j (and 3, 4 ... of couplings): body_i, phi_r_i.x y z, phi_p_i.e0 e1 "
             "e2 e3, phi_pi_i.x y z; fields that do not apply are empty"},
            {"--json", NULL, NULL, "print the same as JSON, in the list `equations`"},
            {0}},
    .examples = (const command_example[]){{"evaluate pendulum.yaml --time 0.5",
                                           "the equations half a second after the start"},
                                          {"evaluate pendulum.yaml --csv", "a table"},
                                          {0}},
    .exits = "0 done; 1 the constraints cannot be evaluated; 2 bad usage or model.",
};
