// Tests that every kind of event has a sentence.
#include "event_words.h"

#include <gtest/gtest.h>

namespace dihaptic::gui::event_words_test {
namespace {

QString said(const char* name, const char* detail) {
    rows::EventRow event;
    event.name = name;
    event.detail = detail;
    return sentence_of(event, {"thumb", "left index"});
}

TEST(EventWords, AreASentenceForEachKind) {
    for (const rows::EventKind& kind : rows::kEventKinds) {
        const QString sentence = said(kind.name, "thumb block");
        EXPECT_NE(sentence, QString(kind.name) + ": thumb block") << kind.name;
        EXPECT_FALSE(sentence.contains("%1")) << kind.name;
    }
}

TEST(EventWords, NameWhoTouchesWhat) {
    EXPECT_EQ(said("touch", "thumb block"), "thumb touches block");
    EXPECT_EQ(said("release", "left index red block"), "left index releases red block");
}

TEST(EventWords, CountBodies) {
    EXPECT_EQ(said("put back", "1 bodies"), "one body is put in its place");
    EXPECT_EQ(said("put back", "3 bodies"), "3 bodies are put in their places");
}

TEST(EventWords, KeepAnEventThatTheyDoNotKnow) {
    EXPECT_EQ(said("sneeze", "loud"), "sneeze: loud");
}

TEST(EventWords, TellWhatWasMeasuredOfAnEpisode) {
    rows::EpisodeRow episode;
    EXPECT_EQ(sentence_of(episode), "the object is held");
    episode.kind = rows::EpisodeKind::flight;
    episode.rise = 0.0204;
    EXPECT_EQ(sentence_of(episode), "the object flies, it rises by 20.40 mm");
}

}  // namespace
}  // namespace dihaptic::gui::event_words_test
