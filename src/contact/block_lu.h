// BlockLu is a sparse LU factorisation of a matrix of 6 x 6 blocks, with one row for each body and
// a block wherever two bodies touch. Bodies with the fewest neighbours are eliminated first, so
// that a wall or a chain causes little fill-in; pivoting is confined to the diagonal blocks.
//
// If the same pattern is solved repeatedly and the blocks of some bodies never change, those bodies
// are eliminated first, and only once, by keep(); each solve then starts by calling again().
//
// All memory is allocated by reserve(); no other function allocates.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace dihaptic::contact {

class BlockLu {
  public:
    using Block = Eigen::Matrix<double, 6, 6>;
    using Vector = Eigen::Matrix<double, 6, 1>;

    void reserve(int nodes, int edges);

    /// Determines the elimination order and the fill-in for a pattern given as unordered pairs of
    /// nodes. `varies` says for each node whether its blocks change between solves; if it is left
    /// out, all of them do. Does nothing if the pattern is unchanged. Returns false if the pattern
    /// is larger than reserved.
    bool analyse(int nodes, std::span<const std::pair<int, int>> edges,
                 std::span<const char> varies = {}) noexcept;

    /// Index of the block in the given row and column; valid until another pattern is analysed.
    int slot(int row, int column) const noexcept {
        return slot_[static_cast<size_t>(row) * static_cast<size_t>(capacity_) +
                     static_cast<size_t>(column)];
    }
    Block& block(int slot) noexcept { return blocks_[static_cast<size_t>(slot)]; }
    void set_identity() noexcept;

    /// Eliminates the nodes that do not vary, and keeps the resulting blocks as the starting point
    /// of each solve.
    void keep() noexcept;
    /// Restores the varying blocks from the copy made by keep().
    void again() noexcept;
    /// Solves for x in place, overwriting the varying blocks. keep() must have been called before.
    void solve(std::span<Vector> x) noexcept;

    int blocks() const noexcept { return used_; }
    /// Cost of a solve, as a number of block products.
    int64_t products() const noexcept { return products_; }

  private:
    bool same_pattern(int nodes, std::span<const std::pair<int, int>> edges,
                      std::span<const char> varies) const noexcept;
    void forget_pattern() noexcept;
    void connect(int nodes, std::span<const std::pair<int, int>> edges) noexcept;
    int degree_of(int node) noexcept;
    int least_connected(int nodes, bool varies) const noexcept;
    bool eliminate(int node) noexcept;
    void count_products() noexcept;
    /// Neighbours of the k-th node in the elimination order that are eliminated after it.
    std::span<const int> later(size_t k) const noexcept {
        return {later_.data() + later_begin_[k], later_begin_[k + 1] - later_begin_[k]};
    }
    /// Eliminates the k-th node in the elimination order from the blocks of the nodes that follow
    /// it.
    void factorise(size_t k) noexcept;
    int& slot_of(int row, int column) noexcept {
        return slot_[static_cast<size_t>(row) * static_cast<size_t>(capacity_) +
                     static_cast<size_t>(column)];
    }
    uint64_t* neighbours(int node) noexcept {
        return &adjacency_[static_cast<size_t>(node) * words_];
    }

    int capacity_ = 0;
    size_t words_ = 0;       // number of words in a row of adjacency_
    size_t used_words_ = 0;  // number of words needed for the nodes of the pattern
    int nodes_ = 0;
    int used_ = 0;
    int64_t products_ = 0;
    std::vector<std::pair<int, int>> edges_;  // the analysed pattern
    std::vector<uint64_t> adjacency_;         // one bit set of neighbours per node
    std::vector<int> degree_;
    std::vector<char> eliminated_;
    std::vector<char> varies_;  // for each node, whether its blocks vary
    std::vector<int> order_;
    size_t constant_ = 0;     // number of nodes that do not vary; they come first in the order
    int first_varying_ = 0;   // index of the first block of the varying nodes
    std::vector<int> later_;  // for each node in order: its neighbours eliminated later
    std::vector<size_t> later_begin_;
    std::vector<int> slot_;  // block index by row and column; -1 if there is no block
    std::vector<Block> blocks_;
    std::vector<Block> kept_;  // copy of the blocks of the varying nodes
};

}  // namespace dihaptic::contact
