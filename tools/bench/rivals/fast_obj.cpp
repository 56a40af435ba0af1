// fast_obj, as a rival of `read`: `src/read/fast_obj.rs` compiles, starts and asks it.
//
// The argument is a file, which is taken into memory. To each line on the standard input the answer
// is a line: the seconds of CPU time that reading took, and how many vertices and faces there are.

#define FAST_OBJ_IMPLEMENTATION
#include "fast_obj.h"

#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

static std::string file;
static size_t at;

static void* open(const char*, void*) { return &file; }
static void close(void*, void*) {}
static unsigned long size(void*, void*) { return file.size(); }
static size_t read(void*, void* to, size_t most, void*) {
    const size_t count = most < file.size() - at ? most : file.size() - at;
    std::memcpy(to, file.data() + at, count);
    at += count;
    return count;
}

static double seconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

int main(int, char** arguments) {
    FILE* input = std::fopen(arguments[1], "rb");
    if (!input) return 1;
    std::fseek(input, 0, SEEK_END);
    file.resize(size_t(std::ftell(input)));
    std::rewind(input);
    if (std::fread(file.data(), 1, file.size(), input) != file.size()) return 1;
    std::printf("ready fast_obj %d.%d\n", FAST_OBJ_VERSION_MAJOR, FAST_OBJ_VERSION_MINOR);
    std::fflush(stdout);
    const fastObjCallbacks callbacks = {open, close, read, size};
    while (std::getchar() == '\n') {
        at = 0;
        const double start = seconds();
        fastObjMesh* mesh = fast_obj_read_with_callbacks("sheet.obj", &callbacks, nullptr);
        const double time = seconds() - start;
        // The first of each kind is a dummy.
        std::printf("%.9f %u %u\n", time, mesh->position_count - 1, mesh->face_count);
        std::fflush(stdout);
        fast_obj_destroy(mesh);
    }
}
