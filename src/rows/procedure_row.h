// A row of procedures.csv: a procedure of the task's, as the analysis of its answers takes it.
#pragma once

#include <string>

#include "base/unmeasured.h"
#include "model/psychometric.h"
#include "rows/row_file.h"

namespace dihaptic::rows {

struct ProcedureRow {
    std::string procedure;
    std::string kind;
    std::string perturbation;
    bool logarithmic = false;
    std::string yes, no;
    model::Sigmoid sigmoid = model::Sigmoid::normal;
    double shape = kUnmeasured;
    double guess = kUnmeasured;
    bool guess_is_lapse = false;
    std::string level;
    double standard = kUnmeasured;

    template <class Self, class Visitor>
    static void visit(Self& f, Visitor& v) {
        v("procedure", f.procedure, "", "name");
        v("kind", f.kind, "", "staircase, quest, quest_plus or constant");
        v("perturbation", f.perturbation, "", "whose share it chooses, or that acts");
        v("logarithmic", f.logarithmic, "", "the share, or the number, is 10^level");
        v("yes", f.yes, "", "outcome that grows likelier with the level");
        v("no", f.no, "", "the other");
        v("sigmoid", f.sigmoid, "", "of the psychometric function");
        v("shape", f.shape, "1",
          "its shape, where the procedure takes it as known; empty: it is fitted");
        v("guess", f.guess, "1", "its lower end");
        v("guess_is_lapse", f.guess_is_lapse, "", "or the lapse rate is");
        v("level", f.level, "",
          "column of trials.csv with the number that it chooses; empty: share");
        v("standard", f.standard, "1", "of that number");
    }
};

using ProcedureFile = RowFile<ProcedureRow>;

}  // namespace dihaptic::rows
