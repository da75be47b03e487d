// The sweep, compiled once for each instruction set: a source file sets kLanes
// and includes this. Everything is in an unnamed namespace and calls nothing of
// the standard library, so that no code for a newer processor can take the
// place of a function of the same name elsewhere in the program.
//
// Rows are relaxed from the row above, all the way down, then from the row
// below, all the way up, and so on until nothing changes: the fixpoint of
// Bellman's equation. A row is worked on in blocks of kLanes cells, and only
// where the row it is relaxed from has changed since it last was. This file has
// the order of the work, sweep_relaxer.h the work on one block, sweep_blocks.h
// the sets of blocks that are still to be done, sweep_lanes.h the vectors.

#include <cstdint>

#include "terrain/sweep_blocks.h"
#include "terrain/sweep_relaxer.h"
#include "terrain/sweep_task.h"

namespace terra {
namespace {

class Sweeper {
 public:
  explicit Sweeper(SweepTask& task)
      : task_(task),
        relaxer_(task),
        num_words_(WordsFor(relaxer_.num_blocks())) {}

  void Run() {
    task_.first_row = task_.start_row;
    task_.last_row = task_.start_row;
    ClearRow(0);
    ClearRow(task_.start_row);
    relaxer_.Row(task_.start_row)[task_.start_column] = 0;
    // Relaxed from the blocked row 0, only the start's own row is worked on.
    const int block = (task_.start_column - task_.first_column) / kLanes;
    BlockWord active[kMaxWords] = {};
    BlockWord changed[kMaxWords] = {};
    AddBlock(active, block);
    AddBlock(changed, block);
    RelaxRow(task_.start_row, 0, active, changed);
    int way = task_.goal_row < task_.start_row ? -1 : 1;
    Pass(way);
    do {
      ++task_.passes;
      way = -way;
    } while (Pass(way));
  }

 private:
  // The blocks of a row that have changed since the row below (way = 1) or
  // above (way = -1) was relaxed from it.
  BlockWord* Pending(int way, int y) const {
    return task_.pending +
           (std::int64_t{y} * 2 + (way > 0 ? 1 : 0)) * task_.words_per_row;
  }

  void ClearRow(int y) {
    relaxer_.ClearRow(y);
    for (int w = 0; w < num_words_; ++w) {
      Pending(1, y)[w] = 0;
      Pending(-1, y)[w] = 0;
    }
  }

  // Rows are cleared when the search first comes to them.
  void TouchRow(int y) {
    if (y < task_.first_row) {
      ClearRow(task_.first_row = y);
    } else if (y > task_.last_row) {
      ClearRow(task_.last_row = y);
    }
  }

  // Relaxes all rows from their neighbours in one direction. Returns whether
  // there was anything to do.
  bool Pass(int way) {
    bool any = false;
    const int end = way > 0 ? task_.rows - 2 : 1;
    for (int y = way > 0 ? task_.first_row : task_.last_row;
         y != end && y >= task_.first_row && y <= task_.last_row; y += way) {
      // A diagonal step reaches the blocks beside those that have changed.
      BlockWord active[kMaxWords];
      if (TakeWithNeighbours(Pending(way, y), relaxer_.num_blocks(), active)) {
        TouchRow(y + way);
        BlockWord changed[kMaxWords] = {};
        RelaxRow(y + way, y, active, changed);
        any = true;
      }
    }
    return any;
  }

  // Relaxes the active blocks of a row from the row beside it and lets what has
  // changed spread along the row. Adds the blocks in which a key fell to
  // `changed`; uses up `active`.
  void RelaxRow(int y, int from, BlockWord* active, BlockWord* changed) {
    BlockWord improved_from_east[kMaxWords] = {};
    RelaxEastward(y, from, active, changed, improved_from_east);
    SpreadWestward(y, improved_from_east, changed);
    for (int w = 0; w < num_words_; ++w) {
      Pending(1, y)[w] |= changed[w];
      Pending(-1, y)[w] |= changed[w];
    }
    const std::uint32_t* row = relaxer_.Row(y);
    // Paths as cheap as the best stay wanted: the tie rule chooses among all.
    if (y == task_.goal_row && row[task_.goal_column] < task_.bound) {
      task_.bound = row[task_.goal_column] + 1;
      task_.found = true;
    }
  }

  // From west to east, where keys that are handed on activate the next block.
  // Notes the blocks to which keys are to be handed on westward.
  void RelaxEastward(int y, int from, BlockWord* active, BlockWord* changed,
                     BlockWord* improved_from_east) {
    for (int w = 0; w < num_words_; ++w) {
      while (active[w] != 0) {
        const int block = TakeWestmost(active, w);
        if (relaxer_.RelaxFromRow(y, from, block)) {
          AddBlock(changed, block);
        }
        if (!HasBlock(changed, block)) {
          continue;
        }
        if (relaxer_.LeadsOn<East>(y, block)) {
          AddBlock(active, block + 1);
        }
        if (relaxer_.LeadsOn<West>(y, block)) {
          AddBlock(improved_from_east, block - 1);
        }
      }
    }
  }

  // From east to west, over the few blocks that have a use for it.
  void SpreadWestward(int y, BlockWord* improved_from_east,
                      BlockWord* changed) {
    for (int w = num_words_ - 1; w >= 0; --w) {
      while (improved_from_east[w] != 0) {
        const int block = TakeEastmost(improved_from_east, w);
        if (!relaxer_.SpreadFromEast(y, block)) {
          continue;
        }
        AddBlock(changed, block);
        if (relaxer_.LeadsOn<West>(y, block)) {
          AddBlock(improved_from_east, block - 1);
        }
      }
    }
  }

  SweepTask& task_;
  BlockRelaxer relaxer_;
  int num_words_;
};

}  // namespace
}  // namespace terra
