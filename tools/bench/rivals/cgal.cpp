// CGAL's Surface_mesh, as a rival of `build`: `src/build/cgal.rs` compiles, starts and asks it.
//
// The standard input begins with the number of vertices, the number of triangles, and their corners.
// To each line behind that the answer is a line: to `build` the seconds of CPU time that it took to add all
// vertices and triangles to an empty mesh, and how many triangles there are; to `walk` the seconds of a walk
// over the triangles round each vertex of the mesh that was built last, and how many it came to.

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

static double seconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

static std::unique_ptr<Mesh> build(unsigned vertices, const std::vector<unsigned>& corners) {
    auto mesh = std::make_unique<Mesh>();
    mesh->reserve(vertices, unsigned(corners.size() / 2 + vertices), unsigned(corners.size() / 3));
    for (unsigned v = 0; v < vertices; ++v) mesh->add_vertex();
    using Vertex = Mesh::Vertex_index;
    for (size_t i = 0; i < corners.size(); i += 3)
        mesh->add_face(Vertex(corners[i]), Vertex(corners[i + 1]), Vertex(corners[i + 2]));
    return mesh;
}

int main() {
    unsigned vertices = 0, triangles = 0;
    if (std::scanf("%u %u", &vertices, &triangles) != 2) return 1;
    std::vector<unsigned> corners(3 * size_t(triangles));
    for (unsigned& corner : corners)
        if (std::scanf("%u", &corner) != 1) return 1;
    std::printf("ready %s\n", CGAL_VERSION_STR);
    std::fflush(stdout);
    auto mesh = build(vertices, corners);
    char word[16];
    while (std::scanf("%15s", word) == 1) {
        const double start = seconds();
        double time = 0;
        size_t count = 0, sum = 0;
        if (word == std::string("build")) {
            auto built = build(vertices, corners);
            time = seconds() - start;
            count = built->number_of_faces();
            mesh.swap(built);
        } else {
            for (auto v : mesh->vertices())
                for (auto f : mesh->faces_around_target(mesh->halfedge(v)))
                    if (f != Mesh::null_face()) ++count, sum += size_t(f);
            time = seconds() - start;
        }
        std::printf("%.9f %zu %zu\n", time, count, sum);
        std::fflush(stdout);
    }
}
