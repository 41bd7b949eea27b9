#include "column_words.h"

#include "base/unit.h"

namespace dihaptic::gui {

QString column_words(const QString& name) {
    const std::string key = name.toStdString();
    const NameInUnit parts = split_unit(key);
    QString words = QString::fromStdString(std::string(parts.name)).replace('_', ' ');
    if (parts.name.size() + 1 >= key.size()) return words;
    const QString unit = QString::fromStdString(key.substr(parts.name.size() + 1));
    return QString("%1 [%2]").arg(words, QString(unit).replace('_', '/'));
}

}  // namespace dihaptic::gui
