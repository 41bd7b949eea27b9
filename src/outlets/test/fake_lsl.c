/* Stands in for liblsl: writes what it is told to the file that DIHAPTIC_FAKE_LSL names. It refuses
   what liblsl 1.17 refuses, in the same way; dihaptic_fake_lsl_fail() makes it fail at will. */
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
    snprintf(text, sizeof text, "info|%s|%s|%d|%g|%d|%s\n", name, type, channels, rate, format,
             source);
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
    int length = snprintf(text, sizeof text, "sample|%s|%.6f", stream->name, time);
    for (int i = 0; i < stream->channels; ++i)
        length += snprintf(text + length, sizeof text - (size_t)length, "|%g", (double)values[i]);
    snprintf(text + length, sizeof text - (size_t)length, "\n");
    tell(text);
    return 0;
}

int32_t lsl_push_sample_strt(void* outlet, const char** values, double time) {
    char text[256];
    const struct stream* stream = given(outlet);
    if (atomic_load(&fails) >= 3) return -2;
    if (stream->format != 3) return argument_error;
    snprintf(text, sizeof text, "mark|%s|%.6f|%s\n", stream->name, time, values[0]);
    tell(text);
    return 0;
}
