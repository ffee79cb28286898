/* SPDX-License-Identifier: BSD-3-Clause */
/* Safe reading and writing, on POSIX systems and on Windows. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE    700
#define _DARWIN_C_SOURCE /* flock */
#endif

#include "io/base/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"

enum { PATH_SIZE = 4300 };

#if defined(_WIN32)
#include <direct.h>
#include <io.h>
int se3di_file_forbid(const char *path)
{
    (void)path;
    return 0; /* opening it fails there */
}

bool se3di_file_is_same(const char *a, const char *b)
{
    char whole_a[PATH_SIZE];
    char whole_b[PATH_SIZE];
    return _fullpath(whole_a, a, sizeof whole_a) && _fullpath(whole_b, b, sizeof whole_b) &&
           _stricmp(whole_a, whole_b) == 0;
}

/* In memory of malloc. */
static char *find_whole(const char *path)
{
    return _fullpath(NULL, path, 0);
}

FILE *se3di_file_create(const char *path)
{
    return fopen(path, "wbx");
}

FILE *se3di_file_open(const char *path)
{
    return fopen(path, "rb");
}

static void take_away(const char *path)
{
    remove(path);
}

static bool cut(FILE *file, uint64_t size)
{
    return _chsize_s(_fileno(file), (long long)size) == 0;
}

bool se3di_file_seek(FILE *file, uint64_t place)
{
    return _fseeki64(file, (long long)place, SEEK_SET) == 0;
}

FILE *se3di_file_continue(const char *path)
{
    FILE *file = fopen(path, "r+b");
    return file ? file : fopen(path, "w+b");
}

bool se3di_file_sync(FILE *file)
{
    return fflush(file) == 0 && _commit(_fileno(file)) == 0;
}

static bool is_link(const char *path)
{
    (void)path;
    return false;
}

static int make_folder(const char *path)
{
    return _mkdir(path);
}

bool se3di_temporary_make(const char *within, char *path, size_t size)
{
    (void)within;
    (void)path;
    (void)size;
    errno = ENOSYS;
    return false;
}

void se3di_temporary_remove(const char *path)
{
    (void)path;
}

bool se3di_temporary_hold(const char *within, char *path, size_t size, int *hold)
{
    *hold = -1;
    return se3di_temporary_make(within, path, size);
}

void se3di_temporary_release(const char *path, int hold)
{
    (void)path;
    (void)hold;
}
#else
#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* In memory of malloc. */
static char *find_whole(const char *path)
{
    return realpath(path, NULL);
}

FILE *se3di_file_create(const char *path)
{
    const int number = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *file = number >= 0 ? fdopen(number, "wb") : NULL;
    if (number >= 0 && !file) {
        close(number);
    }
    return file;
}

FILE *se3di_file_open(const char *path)
{
    struct stat about;
    const int number = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (number < 0) {
        return NULL;
    }
    const bool known = fstat(number, &about) == 0;
    FILE *file = known && S_ISREG(about.st_mode) ? fdopen(number, "rb") : NULL;
    if (!file) {
        const int why = !known                    ? errno
                        : S_ISDIR(about.st_mode)  ? EISDIR
                        : !S_ISREG(about.st_mode) ? EINVAL
                                                  : ENOMEM;
        close(number);
        errno = why;
    }
    return file;
}

/* A file, or a link to one; unlike remove, it leaves folders alone. */
static void take_away(const char *path)
{
    unlink(path);
}

int se3di_file_forbid(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0) {
        return 0;
    }
    return S_ISDIR(about.st_mode) ? EISDIR : S_ISREG(about.st_mode) ? 0 : EINVAL;
}

bool se3di_file_is_same(const char *a, const char *b)
{
    struct stat of_a;
    struct stat of_b;
    return stat(a, &of_a) == 0 && stat(b, &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
           of_a.st_ino == of_b.st_ino;
}

/* A process that was killed holds its locks until it is gone: whoever goes on at once with its
 * work comes too early, by some milliseconds, on a busy machine by more. */
static int lock_patiently(int number)
{
    const struct timespec pause = {0, 20000000};
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    int result = fcntl(number, F_SETLK, &lock);
    for (int k = 0; k < 100 && result != 0 && (errno == EACCES || errno == EAGAIN); ++k) {
        (void)nanosleep(&pause, NULL);
        result = fcntl(number, F_SETLK, &lock);
    }
    return result;
}

FILE *se3di_file_continue(const char *path)
{
    struct stat about;
    const int number =
        open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (number < 0) {
        return NULL;
    }
    const bool regular = fstat(number, &about) == 0 && S_ISREG(about.st_mode);
    const bool locked = regular && lock_patiently(number) == 0;
    const bool busy = regular && !locked && (errno == EACCES || errno == EAGAIN);
    FILE *file = regular && !busy ? fdopen(number, "r+b") : NULL; /* some disks have no locks */
    if (!file) {
        close(number);
        errno = busy ? EAGAIN : !regular ? EINVAL : ENOMEM;
    }
    return file;
}

static bool cut(FILE *file, uint64_t size)
{
    return ftruncate(fileno(file), (off_t)size) == 0;
}

bool se3di_file_seek(FILE *file, uint64_t place)
{
    return fseeko(file, (off_t)place, SEEK_SET) == 0;
}

bool se3di_file_sync(FILE *file)
{
    return fflush(file) == 0 && (fsync(fileno(file)) == 0 || errno == EINVAL); /* no disk */
}

static bool is_link(const char *path)
{
    struct stat about;
    return lstat(path, &about) == 0 && S_ISLNK(about.st_mode);
}

static int make_folder(const char *path)
{
    return mkdir(path, 0777);
}

static const char *choose_folder(const char *within)
{
    return within && within[0] ? within : "/tmp";
}

bool se3di_temporary_make(const char *within, char *path, size_t size)
{
    const int length = snprintf(path, size, "%s/se3d-XXXXXX", choose_folder(within));
    if (length < 0 || (size_t)length >= size) {
        errno = ENAMETOOLONG;
        return false;
    }
    return mkdtemp(path) != NULL; /* mode 0700 */
}

/* A folder of this user, by its name within an open one; no link is followed. @return -1: none */
static int open_folder(int within, const char *name)
{
    struct stat about;
    const int number = openat(within, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (number >= 0 && (fstat(number, &about) != 0 || about.st_uid != geteuid())) {
        close(number);
        return -1;
    }
    return number;
}

/* Take away what is in an open folder, whatever its name leads to meanwhile; what stays is left
 * behind. */
static void empty_folder(int folder, int depth)
{
    enum { DEEPEST = 64 };
    const int again = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *entries = again >= 0 ? fdopendir(again) : NULL;
    if (!entries && again >= 0) {
        close(again);
    }
    for (struct dirent *entry = entries ? readdir(entries) : NULL; entry;
         entry = readdir(entries)) {
        const char *name = entry->d_name;
        if (strcmp(name, ".") == 0 || strcmp(name, "..") == 0 || unlinkat(folder, name, 0) == 0) {
            continue;
        }
        const int inner = depth < DEEPEST ? open_folder(folder, name) : -1;
        if (inner >= 0) {
            empty_folder(inner, depth + 1);
            close(inner);
        }
        (void)unlinkat(folder, name, AT_REMOVEDIR);
    }
    if (entries) {
        closedir(entries);
    }
}

/* Take an open folder away, by its name within another one if that is still its. */
static void remove_folder(int folder, int within, const char *name)
{
    struct stat own;
    struct stat named;
    empty_folder(folder, 0);
    if (fstat(folder, &own) == 0 && fstatat(within, name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
        own.st_dev == named.st_dev && own.st_ino == named.st_ino) {
        (void)unlinkat(within, name, AT_REMOVEDIR); /* another one would have to be empty */
    }
}

void se3di_temporary_remove(const char *path)
{
    const int folder = open_folder(AT_FDCWD, path);
    if (folder >= 0) {
        remove_folder(folder, AT_FDCWD, path);
        close(folder);
    }
}

/* Folders that are held have the name of the second kind, and get it once they are locked: the lock
 * goes with the process, so one that can be locked is nobody's. */
static const char held_mark[] = "se3d-held-";
enum { RANDOM = 6 }; /* characters of mkdtemp behind it */

/* Lock a folder of this user. @return -1: it is none, or another process has it */
static int lock_folder(int within, const char *name)
{
    const int number = open_folder(within, name);
    if (number >= 0 && flock(number, LOCK_EX | LOCK_NB) != 0) {
        close(number);
        return -1;
    }
    return number;
}

static bool has_held_name(const char *name)
{
    const size_t length = strlen(held_mark);
    return strncmp(name, held_mark, length) == 0 && strlen(name + length) == RANDOM;
}

static void sweep(const char *within)
{
    DIR *folder = opendir(within);
    for (struct dirent *entry = folder ? readdir(folder) : NULL; entry; entry = readdir(folder)) {
        const char *name = entry->d_name;
        const int hold = has_held_name(name) ? lock_folder(dirfd(folder), name) : -1;
        if (hold >= 0) {
            remove_folder(hold, dirfd(folder), name);
            close(hold);
        }
    }
    if (folder) {
        closedir(folder);
    }
}

bool se3di_temporary_hold(const char *within, char *path, size_t size, int *hold)
{
    char name[PATH_SIZE];
    *hold = -1;
    sweep(choose_folder(within));
    if (!se3di_temporary_make(within, path, size)) {
        return false;
    }
    const char *random = path + strlen(path) - RANDOM;
    const int length =
        snprintf(name, sizeof name, "%s/%s%s", choose_folder(within), held_mark, random);
    if (length < 0 || (size_t)length >= sizeof name || (size_t)length >= size) {
        return true; /* it stays as it is */
    }
    *hold = lock_folder(AT_FDCWD, path);
    if (*hold >= 0 && rename(path, name) == 0) {
        memcpy(path, name, (size_t)length + 1);
    }
    return true;
}

void se3di_temporary_release(const char *path, int hold)
{
    if (hold < 0) {
        se3di_temporary_remove(path);
        return;
    }
    remove_folder(hold, AT_FDCWD, path);
    close(hold);
}
#endif

const char *se3di_file_get_text(int why)
{
    return why == EINVAL ? "is no regular file" : strerror(why);
}

static bool is_separator(char c)
{
#if defined(_WIN32)
    return c == '/' || c == '\\';
#else
    return c == '/';
#endif
}

bool se3di_file_make_folders(const char *path)
{
    char part[4096];
    const size_t length = strlen(path);
    if (length >= sizeof part) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t k = 0; k < length; ++k) {
        part[k] = path[k];
        if (k == 0 || !is_separator(path[k]) || is_separator(path[k - 1])) {
            continue;
        }
        part[k] = '\0';
        if (make_folder(part) != 0 && errno != EEXIST && errno != EISDIR && errno != EACCES) {
            return false; /* a folder without permission is reported when the file is opened */
        }
        part[k] = path[k];
    }
    return true;
}

bool se3di_file_join(const char *folder, const char *file, char *path, size_t size)
{
    const char *const in = folder ? folder : ".";
    const int length = snprintf(path, size, "%s/%s", in, file);
    if (length < 0 || (size_t)length >= size) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t k = strlen(in) + 1; k <= (size_t)length; ++k) {
        const char c = path[k];
        if (c != '\0' && !is_separator(c)) {
            continue;
        }
        path[k] = '\0';
        const bool leads_away = is_link(path);
        path[k] = c;
        if (leads_away) {
            errno = ELOOP;
            return false;
        }
    }
    return true;
}

bool se3di_file_is_hdf5(const char *name)
{
    const char *ending = strrchr(name, '.');
    return ending && (strcmp(ending, ".h5") == 0 || strcmp(ending, ".hdf5") == 0);
}

bool se3di_file_find_folder(const char *folder, char *path, size_t size)
{
    char *whole = find_whole(folder[0] ? folder : ".");
    if (!whole) {
        return false;
    }
    const size_t used = strlen(whole);
    const char *end = used > 0 && is_separator(whole[used - 1]) ? "" : "/";
    const int length = snprintf(path, size, "%s%s", whole, end);
    free(whole);
    for (char *c = path; *c; ++c) {
        *c = is_separator(*c) ? '/' : *c;
    }
    errno = ENAMETOOLONG;
    return length >= 0 && (size_t)length < size;
}

/* The path at which a file is written before it has its name. @return false: it is too long. */
static bool format_partial(const char *path, char partial[PATH_SIZE])
{
    const int length = snprintf(partial, PATH_SIZE, "%s.partial", path);
    return length >= 0 && length < PATH_SIZE;
}

FILE *se3di_partial_open(const char *path)
{
    char partial[PATH_SIZE];
    if (!format_partial(path, partial)) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    const int why = se3di_file_forbid(path); /* known before the work, not after it */
    if (why != 0) {
        errno = why;
        return NULL;
    }
    take_away(partial); /* of a run that was ended; or a link, which must not be followed */
    errno = 0;
    return se3di_file_create(partial);
}

/* Whether a file begins with bytes of this hash, which go to `to` if it is not NULL. */
static bool begins_with(FILE *file, uint64_t size, uint64_t hash, FILE *to)
{
    unsigned char block[4096];
    uint64_t found = SE3DI_HASH_START;
    while (size > 0) {
        const size_t wanted = size < sizeof block ? (size_t)size : sizeof block;
        const size_t count = fread(block, 1, wanted, file);
        if (count == 0 || (to && fwrite(block, 1, count, to) != count)) {
            return false;
        }
        found = se3di_hash_bytes(found, block, count);
        size -= count;
    }
    return found == hash;
}

/* The file that has its name already, as one that has not. */
static FILE *copy_whole(const char *path, uint64_t size, uint64_t hash)
{
    FILE *whole = se3di_file_open(path);
    const bool known = whole && begins_with(whole, size, hash, NULL);
    FILE *file = known ? se3di_partial_open(path) : NULL;
    if (file) {
        rewind(whole);
        if (!begins_with(whole, size, hash, file) || fflush(file) != 0) {
            const int why = errno;
            se3di_partial_abandon(file, path);
            file = NULL;
            errno = why ? why : EIO;
        }
    } else if (!known) {
        errno = ESTALE;
    }
    const int why = errno;
    if (whole) {
        fclose(whole);
    }
    errno = why;
    return file;
}

FILE *se3di_partial_continue(const char *path, uint64_t size, uint64_t hash)
{
    char partial[PATH_SIZE];
    if (!format_partial(path, partial)) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    FILE *there = se3di_file_open(partial);
    const bool known = there && begins_with(there, size, hash, NULL);
    if (there) {
        fclose(there);
    }
    if (!known) {
        return copy_whole(path, size, hash);
    }
    FILE *file = se3di_file_continue(partial);
    if (file && !se3di_file_cut(file, size)) {
        const int why = errno;
        fclose(file);
        errno = why;
        return NULL;
    }
    return file;
}

void se3di_file_remove(const char *path)
{
    char partial[PATH_SIZE];
    take_away(path);
    if (format_partial(path, partial)) {
        take_away(partial);
    }
}

void se3di_partial_leave(FILE *file)
{
    fclose(file);
}

bool se3di_file_cut(FILE *file, uint64_t size)
{
    return fflush(file) == 0 && cut(file, size) && fseek(file, 0, SEEK_END) == 0;
}

/* The file takes its name, in place of one that has it. */
static bool replace(const char *partial, const char *path)
{
    const int why = se3di_file_forbid(path); /* what came there meanwhile */
    if (why != 0) {
        errno = why;
        return false;
    }
#if defined(_WIN32)
    remove(path); /* rename does not replace there */
#endif
    return rename(partial, path) == 0;
}

bool se3di_partial_close(FILE *file, const char *path)
{
    char partial[PATH_SIZE];
    const int before = errno;
    errno = 0;
    bool good = !ferror(file);
    format_partial(path, partial);
    good = fclose(file) == 0 && good;
    if (good && replace(partial, path)) {
        return true;
    }
    const int why = errno ? errno : before ? before : ENOSPC; /* a write before has failed */
    take_away(partial);
    errno = why;
    return false;
}

bool se3di_partial_keep(FILE *file, const char *path, uint64_t size)
{
    char partial[PATH_SIZE];
    if (!format_partial(path, partial) || !cut(file, size)) {
        return false;
    }
    fclose(file);
    (void)replace(partial, path); /* else the rows stay where they are */
    return true;
}

void se3di_partial_abandon(FILE *file, const char *path)
{
    char partial[PATH_SIZE];
    fclose(file);
    if (format_partial(path, partial)) {
        take_away(partial);
    }
}
