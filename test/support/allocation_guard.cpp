#include "allocation_guard.h"

#include <cerrno>
#include <cstdlib>

namespace {

thread_local size_t allocations = 0;
thread_local int armed = 0;

}  // namespace

#ifndef DIHAPTIC_SANITIZED

extern "C" {

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);

static void count() {
    if (armed > 0) ++allocations;
}

void* malloc(size_t size) {
    count();
    return __libc_malloc(size);
}
void* calloc(size_t n, size_t size) {
    count();
    return __libc_calloc(n, size);
}
void* realloc(void* p, size_t size) {
    count();
    return __libc_realloc(p, size);
}
void* memalign(size_t alignment, size_t size) {
    count();
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
    count();
    return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, size_t alignment, size_t size) {
    count();
    *out = __libc_memalign(alignment, size);
    return *out == nullptr ? ENOMEM : 0;
}
void free(void* p) {
    if (p != nullptr) count();
    __libc_free(p);
}

}  // extern "C"

#endif

extern "C" {
int dihaptic_allocation_guard = 0;
}

namespace dihaptic::testing {

AllocationGuard::AllocationGuard() {
    allocations = 0;
    ++armed;
}
AllocationGuard::~AllocationGuard() {
    --armed;
}

size_t AllocationGuard::count() const {
    return allocations;
}

bool AllocationGuard::works() {
#ifdef DIHAPTIC_SANITIZED
    return false;
#else
    return true;
#endif
}

}  // namespace dihaptic::testing
