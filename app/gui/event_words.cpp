#include "event_words.h"

#include <QCoreApplication>
#include <QStringList>
#include <cmath>
#include <map>

namespace dihaptic::gui {
namespace {

/// Marks a text for translation; QCoreApplication::translate() looks it up.
constexpr const char* kContext = "Events";

QString translated(const char* text) {
    return QCoreApplication::translate(kContext, text);
}

/// The sentences of events whose detail is used as it is.
const std::map<std::string, const char*> kSentences{
    {"trial", QT_TRANSLATE_NOOP("Events", "a trial begins: %1")},
    {"phase", QT_TRANSLATE_NOOP("Events", "state \"%1\" begins")},
    {"outcome", QT_TRANSLATE_NOOP("Events", "the trial ends: %1")},
    {"answer", QT_TRANSLATE_NOOP("Events", "the participant answers: %1")},
    {"message", QT_TRANSLATE_NOOP("Events", "the participant reads \"%1\"")},
    {"line", QT_TRANSLATE_NOOP("Events", "the participant reads \"%1\"")},
    {"page", QT_TRANSLATE_NOOP("Events", "the participant reads the page \"%1\"")},
    {"sound", QT_TRANSLATE_NOOP("Events", "sound \"%1\" begins")},
    {"sound ends", QT_TRANSLATE_NOOP("Events", "sound \"%1\" ends")},
    {"marker", QT_TRANSLATE_NOOP("Events", "marker %1 is sent")},
    {"setting", QT_TRANSLATE_NOOP("Events", "setting changed: %1")},
    {rows::kNote, QT_TRANSLATE_NOOP("Events", "the operator notes: %1")},
    {"paused", QT_TRANSLATE_NOOP("Events", "the session pauses: %1")},
    {"went on", QT_TRANSLATE_NOOP("Events", "the session goes on %1")},
    {"lift-off", QT_TRANSLATE_NOOP("Events", "%1 leaves its support")},
    {"replaced", QT_TRANSLATE_NOOP("Events", "%1 is put down")},
    {"limit", QT_TRANSLATE_NOOP("Events", "limit reached: %1")},
};

/// Sentence of a finger and an object; `detail` contains both names, which may have blanks.
QString of_touch(const char* sentence, const std::string& detail,
                 const std::vector<std::string>& fingers) {
    for (const std::string& finger : fingers) {
        if (!detail.starts_with(finger + " ")) continue;
        return translated(sentence).arg(QString::fromStdString(finger),
                                        QString::fromStdString(detail.substr(finger.size() + 1)));
    }
    return QString::fromStdString(detail);
}

/// A length as text, e.g. "slip 0.12 mm"; "" if it was not measured. `length`: [m].
QString in_mm(const char* what, double length) {
    if (std::isnan(length)) return {};
    return translated(what).arg(1000 * length, 0, 'f', 2);
}

}  // namespace

QString sentence_of(const rows::EventRow& event, const std::vector<std::string>& fingers) {
    const QString detail = QString::fromStdString(event.detail);
    if (event.name == "touch")
        return of_touch(QT_TRANSLATE_NOOP("Events", "%1 touches %2"), event.detail, fingers);
    if (event.name == "release")
        return of_touch(QT_TRANSLATE_NOOP("Events", "%1 releases %2"), event.detail, fingers);
    if (event.name == "perturbation")
        return event.detail == "on"
                   ? translated(QT_TRANSLATE_NOOP("Events", "a perturbation begins"))
                   : translated(QT_TRANSLATE_NOOP("Events", "the perturbation ends"));
    if (event.name == "put back") {
        const int bodies = detail.section(' ', 0, 0).toInt();
        return bodies == 1
                   ? translated(QT_TRANSLATE_NOOP("Events", "one body is put in its place"))
                   : translated(QT_TRANSLATE_NOOP("Events", "%1 bodies are put in their places"))
                         .arg(bodies);
    }
    const auto known = kSentences.find(event.name);
    if (known != kSentences.end()) return translated(known->second).arg(detail);
    return QString::fromStdString(event.name) + ": " + detail;  // an event of a later version
}

QString sentence_of(const rows::EpisodeRow& episode) {
    const auto kind = [&]() -> const char* {
        switch (episode.kind) {
            case rows::EpisodeKind::hold:
                return QT_TRANSLATE_NOOP("Events", "the object is held");
            case rows::EpisodeKind::slide:
                return QT_TRANSLATE_NOOP("Events", "the object slides");
            default:
                return QT_TRANSLATE_NOOP("Events", "the object flies");
        }
    };
    QStringList out{translated(kind()),
                    in_mm(QT_TRANSLATE_NOOP("Events", "it slips by %1 mm"), episode.slip),
                    in_mm(QT_TRANSLATE_NOOP("Events", "it rises by %1 mm"), episode.rise)};
    out.removeAll(QString());
    return out.join(", ");
}

}  // namespace dihaptic::gui
