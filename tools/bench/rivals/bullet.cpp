// Bullet's soft body, as a rival of `cloth`: `src/cloth/bullet.rs` compiles, starts and asks it.
//
// On the standard input comes a sheet, once:
//
//     particles N links M gravity G
//     x y z mass          N times; metres and kilograms, 0 for a particle that is held
//     a b                 M times
//
// and then a line a run, `run ITERATIONS STEPS STEP_S`. The answer is a line: the seconds of CPU
// time that the steps took, and where the particles are in the end. Each run starts from rest.
//
// The body is nodes and links alone: no faces (so no normals), no collisions, no drag, no world
// around it. A step is the three calls that the world makes of each soft body.

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

struct Sheet {
    std::vector<btVector3> positions;
    std::vector<btScalar> masses;
    std::vector<int> links;
    btScalar gravity = 0;
};

static bool read(Sheet& sheet) {
    int particles, links;
    double gravity;
    if (std::scanf("particles %d links %d gravity %lf", &particles, &links, &gravity) != 3) {
        return false;
    }
    sheet.gravity = btScalar(gravity);
    for (int i = 0; i < particles; ++i) {
        double x, y, z, mass;
        if (std::scanf("%lf %lf %lf %lf", &x, &y, &z, &mass) != 4) {
            return false;
        }
        sheet.positions.push_back(btVector3(btScalar(x), btScalar(y), btScalar(z)));
        sheet.masses.push_back(btScalar(mass));
    }
    for (int i = 0; i < 2 * links; ++i) {
        int end;
        if (std::scanf("%d", &end) != 1 || end < 0 || end >= particles) {
            return false;
        }
        sheet.links.push_back(end);
    }
    return true;
}

static double cpu_seconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

static void run(const Sheet& sheet, bool reoptimised, int iterations, int steps, btScalar step_s) {
    btSoftBodyWorldInfo world;
    world.m_gravity = btVector3(0, sheet.gravity, 0);
    world.air_density = 0;
    btSoftBody body(&world, int(sheet.positions.size()), sheet.positions.data(), sheet.masses.data());
    for (size_t i = 0; i < sheet.links.size(); i += 2) {
        body.appendLink(sheet.links[i], sheet.links[i + 1]);
    }
    // The default material is rigid (kLST = 1); the default configuration has no damping and no drag.
    body.m_cfg.piterations = iterations;
    body.m_cfg.collisions = 0;
    if (reoptimised) {
        btSoftBodyHelpers::ReoptimizeLinkOrder(&body);
    }
    const double start = cpu_seconds();
    for (int i = 0; i < steps; ++i) {
        body.predictMotion(step_s);
        body.solveConstraints();
        body.integrateMotion();
    }
    std::printf("%.9f", cpu_seconds() - start);
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        const btVector3& at = body.m_nodes[i].m_x;
        std::printf(" %.9g %.9g %.9g", double(at.x()), double(at.y()), double(at.z()));
    }
    std::printf("\n");
    std::fflush(stdout);
}

int main(int count, char** arguments) {
    const bool reoptimised = count > 1 && std::strcmp(arguments[1], "reoptimised") == 0;
    Sheet sheet;
    if (!read(sheet)) {
        std::fprintf(stderr, "no sheet on the standard input\n");
        return 1;
    }
    const int version = btGetVersion();
    std::printf("ready %d.%02d\n", version / 100, version % 100);
    std::fflush(stdout);
    int iterations, steps;
    double step_s;
    while (std::scanf(" run %d %d %lf", &iterations, &steps, &step_s) == 3) {
        run(sheet, reoptimised, iterations, steps, btScalar(step_s));
    }
    return 0;
}
