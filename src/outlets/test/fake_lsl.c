/* Stands in for liblsl: writes what it is told to the file that DIHAPTIC_FAKE_LSL names. It refuses
   what liblsl 1.17 refuses, in the same way; dihaptic_fake_lsl_fail() makes it fail at will.

   Its one stream that comes in is the file that DIHAPTIC_FAKE_LSL_IN names, as long as there is one:
   a line with its name and its number of channels, and one with the sample that comes again and
   again, "silent" or "lost". */
#include <locale.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct stream {
    char name[64];
    int channels;
    int format;
};

enum { argument_error = -3 };

static atomic_int fails; /* an enum FakeLslFails of fake_lsl.h */
void dihaptic_fake_lsl_fail(int what) {
    atomic_store(&fails, what);
}

/* Its files have points before decimals in every language. */
static locale_t begin_points(void) {
    return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}
static void end_points(locale_t before) {
    freelocale(uselocale(before));
}

/* The real one uses what it is given without looking. */
static void* given(void* object) {
    if (object == NULL) abort();
    return object;
}

static void tell(const char* text) {
    FILE* out = fopen(getenv("DIHAPTIC_FAKE_LSL"), "a");
    fputs(text, out);
    fclose(out);
}

double lsl_local_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1000 + (double)now.tv_sec + 1e-9 * (double)now.tv_nsec; /* another zero than ours */
}

void* lsl_create_streaminfo(const char* name, const char* type, int32_t channels, double rate,
                            int format, const char* source) {
    char text[512];
    struct stream* info;
    if (name[0] == 0 || channels < 0 || rate < 0 || format < 0 || format > 7) return NULL;
    if (atomic_load(&fails) == 1) return NULL;
    info = calloc(1, sizeof *info);
    strncpy(info->name, name, sizeof info->name - 1);
    info->channels = channels;
    info->format = format;
    const locale_t before = begin_points();
    snprintf(text, sizeof text, "info|%s|%s|%d|%g|%d|%s\n", name, type, channels, rate, format,
             source);
    end_points(before);
    tell(text);
    return info;
}

void lsl_destroy_streaminfo(void* info) {
    free(info);
}
void* lsl_get_desc(void* info) {
    return given(info);
}
void* lsl_append_child(void* element, const char* name) {
    (void)name;
    return element;
}
void* lsl_append_child_value(void* element, const char* name, const char* value) {
    char text[256];
    snprintf(text, sizeof text, "value|%s|%s\n", name, value);
    tell(text);
    return element;
}

void* lsl_create_outlet(void* info, int32_t chunk, int32_t seconds) {
    struct stream* outlet;
    (void)chunk;
    (void)seconds;
    given(info);
    if (atomic_load(&fails) == 2) return NULL;
    outlet = malloc(sizeof *outlet);
    memcpy(outlet, info, sizeof *outlet);
    return outlet;
}

void lsl_destroy_outlet(void* outlet) {
    free(outlet);
}

int32_t lsl_push_sample_ft(void* outlet, const float* values, double time) {
    char text[512];
    const struct stream* stream = given(outlet);
    if (atomic_load(&fails) == 3) return -2;
    if (stream->format == 3) return argument_error;
    const locale_t before = begin_points();
    int length = snprintf(text, sizeof text, "sample|%s|%.6f", stream->name, time);
    for (int i = 0; i < stream->channels; ++i)
        length += snprintf(text + length, sizeof text - (size_t)length, "|%g", (double)values[i]);
    end_points(before);
    snprintf(text + length, sizeof text - (size_t)length, "\n");
    tell(text);
    return 0;
}

int32_t lsl_push_sample_strt(void* outlet, const char** values, double time) {
    char text[256];
    const struct stream* stream = given(outlet);
    if (atomic_load(&fails) >= 3) return -2;
    if (stream->format != 3) return argument_error;
    const locale_t before = begin_points();
    snprintf(text, sizeof text, "mark|%s|%.6f|%s\n", stream->name, time, values[0]);
    end_points(before);
    tell(text);
    return 0;
}

static FILE* stream_in(char name[64], int* channels) {
    const char* path = getenv("DIHAPTIC_FAKE_LSL_IN");
    FILE* file = path ? fopen(path, "r") : NULL;
    if (file && fscanf(file, "%63s %d", name, channels) != 2) {
        fclose(file);
        file = NULL;
    }
    return file;
}

static void wait_for(double seconds) {
    struct timespec time = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&time, NULL);
}

int32_t lsl_resolve_byprop(void** infos, uint32_t most, const char* property, const char* value,
                           int32_t least, double timeout) {
    struct stream* info = calloc(1, sizeof *info);
    FILE* file = stream_in(info->name, &info->channels);
    if (file) fclose(file);
    if (!file || most < 1 || least > 1 || strcmp(property, "name") || strcmp(info->name, value)) {
        free(info);
        wait_for(timeout);
        return 0;
    }
    infos[0] = info;
    return 1;
}

int32_t lsl_get_channel_count(void* info) {
    return ((struct stream*)given(info))->channels;
}

void* lsl_create_inlet(void* info, int32_t buffer, int32_t chunk, int32_t recover) {
    (void)buffer;
    (void)chunk;
    (void)recover;
    return atomic_load(&fails) == 2 ? NULL : memcpy(malloc(sizeof(struct stream)), given(info), sizeof(struct stream));
}

void lsl_destroy_inlet(void* inlet) {
    free(inlet);
}

double lsl_pull_sample_f(void* inlet, float* values, int32_t count, double timeout, int32_t* error) {
    const struct stream* stream = given(inlet);
    char name[64], word[64] = "";
    int channels = 0;
    FILE* file = stream_in(name, &channels);
    *error = count == stream->channels ? 0 : argument_error;
    if (!file || *error) {
        if (file) fclose(file);
        if (!file) *error = -2;
        return 0;
    }
    const locale_t before = begin_points();
    for (int i = 0; i < count && fscanf(file, "%63s", word) == 1; ++i) values[i] = strtof(word, NULL);
    end_points(before);
    fclose(file);
    if (!strcmp(word, "lost")) *error = -2;
    if (!strcmp(word, "silent")) wait_for(timeout);
    if (!strcmp(word, "lost") || !strcmp(word, "silent")) return 0;
    wait_for(0.005); /* 200 samples a second */
    return lsl_local_clock();
}
