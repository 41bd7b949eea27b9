#include "contact/block_lu.h"

#include <algorithm>
#include <bit>

namespace dihaptic::contact {
namespace {

/// Blocks reserved per node; a pile of a hundred bodies needs about ten per node.
constexpr size_t kBlocksPerNode = 24;
constexpr size_t kWordBits = 64;

/// Index of the word, and mask of the bit, that represent a node in a bit set of nodes.
size_t word_of(int node) noexcept {
    return static_cast<size_t>(node) / kWordBits;
}
uint64_t bit_of(int node) noexcept {
    return uint64_t{1} << (static_cast<size_t>(node) % kWordBits);
}

/// Inverts A in place by Gauss-Jordan elimination with pivoting. Operates on columns, which are
/// contiguous in memory.
void invert(BlockLu::Block& A) noexcept {
    BlockLu::Block inverse = BlockLu::Block::Identity();
    for (int k = 0; k < 6; ++k) {
        int pivot = k;
        for (int i = k + 1; i < 6; ++i) {
            if (std::abs(A(k, i)) > std::abs(A(k, pivot))) pivot = i;
        }
        if (pivot != k) {
            A.col(k).swap(A.col(pivot));
            inverse.col(k).swap(inverse.col(pivot));
        }
        const double by = 1 / A(k, k);
        A.col(k) *= by;
        inverse.col(k) *= by;
        for (int i = 0; i < 6; ++i) {
            if (i == k) continue;
            const double factor = A(k, i);
            if (factor == 0) continue;
            A.col(i) -= factor * A.col(k);
            inverse.col(i) -= factor * inverse.col(k);
        }
    }
    A = inverse;
}

}  // namespace

void BlockLu::reserve(int nodes, int edges) {
    capacity_ = nodes;
    const auto n = static_cast<size_t>(nodes);
    words_ = (n + kWordBits - 1) / kWordBits;
    edges_.reserve(static_cast<size_t>(edges));
    adjacency_.assign(n * words_, 0);
    degree_.assign(n, 0);
    eliminated_.assign(n, 0);
    varies_.reserve(n);
    order_.reserve(n);
    later_.reserve(kBlocksPerNode * n);
    later_begin_.reserve(n + 1);
    slot_.assign(n * n, -1);
    blocks_.resize(kBlocksPerNode * n);
    kept_.resize(kBlocksPerNode * n);
    nodes_ = 0;
    used_ = 0;
}

bool BlockLu::same_pattern(int nodes, std::span<const std::pair<int, int>> edges,
                           std::span<const char> varies) const noexcept {
    return nodes == nodes_ &&
           std::equal(edges.begin(), edges.end(), edges_.begin(), edges_.end()) &&
           std::equal(varies.begin(), varies.end(), varies_.begin(), varies_.end());
}

bool BlockLu::analyse(int nodes, std::span<const std::pair<int, int>> edges,
                      std::span<const char> varies) noexcept {
    if (same_pattern(nodes, edges, varies)) return true;
    forget_pattern();
    if (nodes > capacity_ || edges.size() > edges_.capacity()) return false;
    varies_.assign(varies.begin(), varies.end());
    connect(nodes, edges);
    later_begin_.push_back(0);
    const auto count = static_cast<size_t>(nodes);
    constant_ = static_cast<size_t>(std::count(varies.begin(), varies.end(), 0));
    while (order_.size() < constant_) {
        if (!eliminate(least_connected(nodes, false))) return false;
    }
    first_varying_ = used_;
    while (order_.size() < count) {
        if (!eliminate(least_connected(nodes, true))) return false;
    }
    nodes_ = nodes;
    edges_.assign(edges.begin(), edges.end());
    count_products();
    return true;
}

/// Counts the work for each node: inverting its block, and eliminating it from its later neighbours
/// and from each pair of them.
void BlockLu::count_products() noexcept {
    constexpr int64_t kInverse = 8;  // measured in products that take the same time
    products_ = 0;
    for (size_t k = 0; k < order_.size(); ++k) {
        const auto others = static_cast<int64_t>(later(k).size());
        products_ += 1 + others;
        if (k >= constant_) products_ += kInverse + others * (1 + others);
    }
}

void BlockLu::forget_pattern() noexcept {
    for (size_t k = 0; k < order_.size(); ++k) {
        const int i = order_[k];
        slot_of(i, i) = -1;
        for (size_t l = later_begin_[k]; l < later_begin_[k + 1]; ++l) {
            slot_of(i, later_[l]) = slot_of(later_[l], i) = -1;
        }
    }
    order_.clear();
    later_.clear();
    later_begin_.clear();
    nodes_ = 0;
    used_ = 0;
    constant_ = 0;
    first_varying_ = 0;
}

void BlockLu::connect(int nodes, std::span<const std::pair<int, int>> edges) noexcept {
    used_words_ = (static_cast<size_t>(nodes) + kWordBits - 1) / kWordBits;
    for (int i = 0; i < nodes; ++i) {
        std::fill_n(neighbours(i), used_words_, 0);
        eliminated_[static_cast<size_t>(i)] = 0;
    }
    for (const auto& [a, b] : edges) {
        neighbours(a)[word_of(b)] |= bit_of(b);
        neighbours(b)[word_of(a)] |= bit_of(a);
    }
    for (int i = 0; i < nodes; ++i) degree_[static_cast<size_t>(i)] = degree_of(i);
}

int BlockLu::degree_of(int node) noexcept {
    int degree = 0;
    for (size_t w = 0; w < used_words_; ++w) degree += std::popcount(neighbours(node)[w]);
    return degree;
}

/// Returns the node with the fewest neighbours (minimum degree), the first one in a tie, among the
/// remaining nodes that vary or, if `varies` is false, among those that do not.
int BlockLu::least_connected(int nodes, bool varies) const noexcept {
    int least = -1;
    for (int i = 0; i < nodes; ++i) {
        const auto at = static_cast<size_t>(i);
        const bool can_vary = varies_.empty() || varies_[at] != 0;
        if (eliminated_[at] == 0 && can_vary == varies &&
            (least < 0 || degree_[at] < degree_[static_cast<size_t>(least)])) {
            least = i;
        }
    }
    return least;
}

/// Eliminates a node: its neighbours become neighbours of each other, with new blocks for fill-in.
/// Returns false if the memory does not suffice.
bool BlockLu::eliminate(int node) noexcept {
    eliminated_[static_cast<size_t>(node)] = 1;
    order_.push_back(node);
    const size_t begin = later_.size();
    for (size_t w = 0; w < used_words_; ++w) {
        for (uint64_t rest = neighbours(node)[w]; rest != 0; rest &= rest - 1) {
            if (later_.size() == later_.capacity()) {
                order_.pop_back();
                return false;
            }
            later_.push_back(static_cast<int>(w * kWordBits) + std::countr_zero(rest));
        }
    }
    later_begin_.push_back(later_.size());
    const size_t needed = 1 + 2 * (later_.size() - begin);
    if (static_cast<size_t>(used_) + needed > blocks_.size()) return false;
    slot_of(node, node) = used_++;
    for (size_t l = begin; l < later_.size(); ++l) {
        const int j = later_[l];
        slot_of(node, j) = used_++;
        slot_of(j, node) = used_++;
        uint64_t* of_j = neighbours(j);
        for (size_t w = 0; w < used_words_; ++w) of_j[w] |= neighbours(node)[w];
        of_j[word_of(j)] &= ~bit_of(j);
        of_j[word_of(node)] &= ~bit_of(node);
        degree_[static_cast<size_t>(j)] = degree_of(j);
    }
    return true;
}

void BlockLu::set_identity() noexcept {
    for (int i = 0; i < used_; ++i) blocks_[static_cast<size_t>(i)].setZero();
    for (int i = 0; i < nodes_; ++i) block(slot(i, i)).setIdentity();
}

void BlockLu::keep() noexcept {
    for (size_t k = 0; k < constant_; ++k) factorise(k);
    std::copy(blocks_.begin() + first_varying_, blocks_.begin() + used_, kept_.begin());
}

void BlockLu::again() noexcept {
    std::copy_n(kept_.begin(), used_ - first_varying_, blocks_.begin() + first_varying_);
}

void BlockLu::factorise(size_t k) noexcept {
    const int i = order_[k];
    Block& diagonal = block(slot(i, i));
    invert(diagonal);
    for (const int m : later(k)) {
        Block& right = block(slot(i, m));
        right = (diagonal * right).eval();
    }
    for (const int j : later(k)) {
        const Block& below = block(slot(j, i));
        for (const int m : later(k))
            block(slot(j, m)).noalias() -= below.lazyProduct(block(slot(i, m)));
    }
}

void BlockLu::solve(std::span<Vector> x) noexcept {
    for (size_t k = 0; k < order_.size(); ++k) {
        if (k >= constant_) factorise(k);
        const int i = order_[k];
        const Vector x_i = block(slot(i, i)) * x[static_cast<size_t>(i)];
        x[static_cast<size_t>(i)] = x_i;
        for (const int j : later(k)) x[static_cast<size_t>(j)].noalias() -= block(slot(j, i)) * x_i;
    }
    for (size_t k = order_.size(); k-- > 0;) {
        const int i = order_[k];
        for (const int m : later(k))
            x[static_cast<size_t>(i)].noalias() -= block(slot(i, m)) * x[static_cast<size_t>(m)];
    }
}

}  // namespace dihaptic::contact
