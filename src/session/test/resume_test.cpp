// Tests that a session is resumed by the same mover of its hand as before, or not at all.
#include "session/resume.h"

#include "session/test/sessions.h"

namespace dihaptic::session::resume_test {
namespace {

/// Returns the error message if the session cannot be resumed.
std::string refusal(const std::string& session, Seat seat) {
    try {
        rest_of(session, seat, {});
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

/// Makes the session look like one recorded by an earlier version, which did not store the mover.
void forget_mover(const std::string& session) {
    const auto folder = recording::SessionFolder::open(session);
    recording::SessionInfo info = folder.read_info();
    info.moved_by = {};
    folder.write_info(info);
}

TEST(Rest, GoesOnWithTheScriptThatDidTheTrialsBefore) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::script, true);
    const Rest rest = rest_of(cut, Seat::terminal, {});
    EXPECT_EQ(rest.plan.moved_by.mover, Mover::script);
    EXPECT_NE(rest.describe().find("the file's script moves the hand, as before"),
              std::string::npos);
    const auto result = sessions.files.run(rest.plan);
    analysis::finish_session(recording::SessionFolder::open(result.folder), result.info, {});
    const CsvFile trials(result.folder + "/trials.csv");
    ASSERT_GT(trials.rows(), 2u);
    for (size_t i = 0; i < trials.rows(); ++i) EXPECT_EQ(trials.text(i, "moved_by"), "script");
    EXPECT_EQ(trials.text(0, "session_num"), "1");
    EXPECT_EQ(trials.text(trials.rows() - 1, "session_num"), "2");
}

TEST(Rest, OfASimulatedPersonIsDoneByTheSamePerson) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::simulated_person, true, "sim-001");
    const Rest rest = rest_of(cut, Seat::terminal, {});
    EXPECT_EQ(rest.plan.moved_by.mover, Mover::simulated_person);
    EXPECT_EQ(rest.plan.person, testing::read_file(cut + "/person.yaml"));
    // in earlier versions, only that file showed that a person was simulated
    forget_mover(cut);
    EXPECT_EQ(rest_of(cut, Seat::terminal, {}).plan.moved_by.mover, Mover::simulated_person);
    std::filesystem::remove(cut + "/person.yaml");
    EXPECT_NE(refusal(cut, Seat::terminal), "");
}

TEST(Rest, OfAPersonAtAMouseIsNotDoneByAScript) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::mouse);
    const std::string said = refusal(cut, Seat::terminal);
    EXPECT_NE(said.find("a person moved the hand by mouse, which is not available here"),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("Continue in the window"), std::string::npos) << said;
    const Rest rest = rest_of(cut, Seat::window, {});
    EXPECT_EQ(rest.plan.moved_by.mover, Mover::mouse);
    EXPECT_EQ(rest.plan.driver, rest.plan.mouse);
}

TEST(Rest, OfASessionThatDoesNotSayWhoMovedItIsRefused) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::mouse);
    forget_mover(cut);
    for (const Seat seat : {Seat::terminal, Seat::window})
        EXPECT_NE(refusal(cut, seat).find("does not state whether a mouse or the file's script"),
                  std::string::npos);
}

TEST(Rest, IsDoneOnce) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::script, true);
    const Rest one = rest_of(cut, Seat::terminal, {});
    const Rest other = rest_of(cut, Seat::terminal, {});
    const std::string next = sessions.files.run(one.plan).folder;
    // one program is about to resume the session, another comes later
    const auto told = [&](const auto& tried) -> std::string {
        try {
            tried();
            return "";
        } catch (const Error& e) {
            return e.what();
        }
    };
    const std::string wanted = "has already been resumed, as " + next;
    const std::string late = told([&] { sessions.files.run(other.plan); });
    EXPECT_NE(late.find(wanted), std::string::npos) << late;
    EXPECT_NE(refusal(cut, Seat::terminal).find("dihaptic resume " + next), std::string::npos);
    std::filesystem::rename(next, sessions.files.folder.file("elsewhere"));
    EXPECT_EQ(refusal(cut, Seat::terminal), "");
    // a resumed session in another folder is found if that folder is given
    EXPECT_THROW(claim(cut, sessions.files.folder.path()), Error);
    EXPECT_NO_THROW(claim(cut, sessions.files.folder.file("nothing")));
}

TEST(Rest, IsDoneByOneAtATime) {
    Sessions sessions;
    const std::string cut = sessions.make(Mover::script, true);
    const Rest rest = rest_of(cut, Seat::terminal, {});
    const auto before =
        std::distance(std::filesystem::directory_iterator(std::filesystem::path(cut).parent_path()),
                      std::filesystem::directory_iterator());
    {
        const recording::SessionLock other = claim(cut, "");
        EXPECT_THROW(sessions.files.run(rest.plan), Error);
    }
    EXPECT_EQ(
        std::distance(std::filesystem::directory_iterator(std::filesystem::path(cut).parent_path()),
                      std::filesystem::directory_iterator()),
        before);
    sessions.files.run(rest.plan);
}

TEST(Unfinished, SessionsOfTheParticipantAreFoundUntilOneGoesOnWithThem) {
    Sessions sessions;
    const std::string parent = sessions.files.folder.file("sessions");
    EXPECT_TRUE(find_unfinished(parent, "Reaches", "S07").empty());
    sessions.make(Mover::script);
    EXPECT_TRUE(find_unfinished(parent, "Reaches", "S07").empty());
    const std::string cut = sessions.make(Mover::script, true);
    const auto found = find_unfinished(parent, "Reaches", "S07");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].folder, cut);
    EXPECT_EQ(found[0].trials, CsvFile(cut + "/trial-list.csv").rows());
    EXPECT_LT(found[0].done, found[0].trials);
    EXPECT_GT(found[0].done, 0u);
    EXPECT_EQ(found[0].moved_by.mover, Mover::script);
    EXPECT_TRUE(find_unfinished(parent, "Reaches", "S08").empty());
    EXPECT_TRUE(find_unfinished(parent, "Lifts", "S07").empty());
    sessions.files.run(rest_of(cut, Seat::terminal, {}).plan);
    EXPECT_TRUE(find_unfinished(parent, "Reaches", "S07").empty());
}

}  // namespace
}  // namespace dihaptic::session::resume_test
