/* SPDX-License-Identifier: BSD-3-Clause */
/* Written by tools/math_tables.py. Most significant word first. */

#include <stdint.h>

/* ln 2 */
static const uint32_t ln2_words[12] = {
    UINT32_C(0xb17217f7), UINT32_C(0xd1cf79ab), UINT32_C(0xc9e3b398), UINT32_C(0x03f2f6af),
    UINT32_C(0x40f34326), UINT32_C(0x7298b62d), UINT32_C(0x8a0d175b), UINT32_C(0x8baafa2b),
    UINT32_C(0xe7b87620), UINT32_C(0x6debac98), UINT32_C(0x559552fb), UINT32_C(0x4afa1b10)};

/* pi / 4 */
static const uint32_t quarter_pi_words[12] = {
    UINT32_C(0xc90fdaa2), UINT32_C(0x2168c234), UINT32_C(0xc4c6628b), UINT32_C(0x80dc1cd1),
    UINT32_C(0x29024e08), UINT32_C(0x8a67cc74), UINT32_C(0x020bbea6), UINT32_C(0x3b139b22),
    UINT32_C(0x514a0879), UINT32_C(0x8e3404dd), UINT32_C(0xef9519b3), UINT32_C(0xcd3a431b)};

/* 2 / pi: its first 1664 bits */
static const uint32_t two_over_pi[52] = {
    UINT32_C(0xa2f9836e), UINT32_C(0x4e441529), UINT32_C(0xfc2757d1), UINT32_C(0xf534ddc0),
    UINT32_C(0xdb629599), UINT32_C(0x3c439041), UINT32_C(0xfe5163ab), UINT32_C(0xdebbc561),
    UINT32_C(0xb7246e3a), UINT32_C(0x424dd2e0), UINT32_C(0x06492eea), UINT32_C(0x09d1921c),
    UINT32_C(0xfe1deb1c), UINT32_C(0xb129a73e), UINT32_C(0xe88235f5), UINT32_C(0x2ebb4484),
    UINT32_C(0xe99c7026), UINT32_C(0xb45f7e41), UINT32_C(0x3991d639), UINT32_C(0x835339f4),
    UINT32_C(0x9c845f8b), UINT32_C(0xbdf9283b), UINT32_C(0x1ff897ff), UINT32_C(0xde05980f),
    UINT32_C(0xef2f118b), UINT32_C(0x5a0a6d1f), UINT32_C(0x6d367ecf), UINT32_C(0x27cb09b7),
    UINT32_C(0x4f463f66), UINT32_C(0x9e5fea2d), UINT32_C(0x7527bac7), UINT32_C(0xebe5f17b),
    UINT32_C(0x3d0739f7), UINT32_C(0x8a5292ea), UINT32_C(0x6bfb5fb1), UINT32_C(0x1f8d5d08),
    UINT32_C(0x56033046), UINT32_C(0xfc7b6bab), UINT32_C(0xf0cfbc20), UINT32_C(0x9af4361d),
    UINT32_C(0xa9e39161), UINT32_C(0x5ee61b08), UINT32_C(0x6599855f), UINT32_C(0x14a06840),
    UINT32_C(0x8dffd880), UINT32_C(0x4d732731), UINT32_C(0x06061556), UINT32_C(0xca73a8c9),
    UINT32_C(0x60e27bc0), UINT32_C(0x8c6b47c4), UINT32_C(0x19c367cd), UINT32_C(0xdce8092a)};
