// What LLVM calls in code for ThreadSanitizer and the runtime of GCC does not have: the same by the names that it watches.
#include <cstring>

extern "C" {
void* __tsan_memcpy(void* to, void const* from, std::size_t size) { return std::memcpy(to, from, size); }
void* __tsan_memmove(void* to, void const* from, std::size_t size) { return std::memmove(to, from, size); }
void* __tsan_memset(void* to, int value, std::size_t size) { return std::memset(to, value, size); }
}
