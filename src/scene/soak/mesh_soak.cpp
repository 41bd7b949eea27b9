// Reads ten thousand damaged meshes. The program must survive each of them, and give a reason for
// each refusal.
#include <thread>

#include "scene/test/mutated_mesh.h"

namespace dihaptic::scene {
namespace {

TEST(MeshSoak, NoDamagedMeshEndsTheProgram) {
    constexpr uint64_t kFiles = 10000;
    constexpr uint64_t kThreads = 4;
    const std::vector<MeshFile> whole = whole_meshes();
    std::array<Outcomes, kThreads> outcomes;
    std::vector<std::thread> threads;
    for (uint64_t i = 0; i < kThreads; ++i)
        threads.emplace_back([&, i] { outcomes[i] = read_damaged(whole, i, kFiles, kThreads); });
    for (std::thread& thread : threads) thread.join();
    Outcomes sum;
    for (const Outcomes& one : outcomes) sum.add(one);
    std::puts(sum.text().c_str());
    EXPECT_EQ(sum.all(), kFiles);
    EXPECT_LT(sum.slowest, 90);
    for (const std::string& message : sum.untold) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace dihaptic::scene
