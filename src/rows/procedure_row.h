// A row of procedures.csv, which describes a procedure of the task as needed for the analysis of
// its answers.
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
        v("procedure", f.procedure, "", "name of the procedure");
        v("kind", f.kind, "", "staircase, quest, quest_plus or constant");
        v("perturbation", f.perturbation, "",
          "perturbation whose share the procedure chooses, or that acts");
        v("logarithmic", f.logarithmic, "", "whether the share, or the number, is 10^level");
        v("yes", f.yes, "", "outcome that becomes more likely as the level rises");
        v("no", f.no, "", "the other outcome");
        v("sigmoid", f.sigmoid, "", "sigmoid of the psychometric function");
        v("shape", f.shape, "1",
          "shape of that function, if the procedure assumes it; empty: fitted");
        v("guess", f.guess, "1", "lower end of that function");
        v("guess_is_lapse", f.guess_is_lapse, "", "whether the lower end is the lapse rate");
        v("level", f.level, "",
          "column of trials.csv that holds the number chosen by the procedure; empty: the column "
          "`share`");
        v("standard", f.standard, "1", "standard value of that number");
    }
};

using ProcedureFile = RowFile<ProcedureRow>;

}  // namespace dihaptic::rows
