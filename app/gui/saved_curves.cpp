#include "saved_curves.h"

#include <QBuffer>
#include <QImage>
#include <QPainter>
#include <QPdfWriter>
#include <QSvgGenerator>

#include "analysis/curves.h"
#include "edited_file.h"
#include "time_chart.h"

namespace dihaptic::gui {
namespace {

constexpr int kSharpness = 3;  // pixels of a saved picture per pixel of the chart
constexpr int kDpi = 96;       // dots per inch at which a chart has its size on the screen

void draw_svg(QWidget& chart, QBuffer& to) {
    QSvgGenerator device;
    device.setOutputDevice(&to);
    device.setSize(chart.size());
    device.setViewBox(chart.rect());
    device.setResolution(kDpi);
    chart.render(&device, QPoint(), QRegion(), QWidget::DrawChildren);
}

void draw_pdf(QWidget& chart, QBuffer& to) {
    QPdfWriter device(&to);
    device.setResolution(kDpi);
    constexpr double kPoint = 72.0 / kDpi;  // size of a pixel [pt]
    device.setPageSize(QPageSize(QSizeF(chart.width() * kPoint, chart.height() * kPoint),
                                 QPageSize::Point, QString(), QPageSize::ExactMatch));
    device.setPageMargins(QMarginsF());
    chart.render(&device, QPoint(), QRegion(), QWidget::DrawChildren);
}

void draw_png(QWidget& chart, QBuffer& to) {
    QImage picture(chart.size() * kSharpness, QImage::Format_RGB32);
    picture.setDevicePixelRatio(kSharpness);
    picture.fill(Qt::white);
    chart.render(&picture, QPoint(), QRegion(), QWidget::DrawChildren);
    picture.save(&to, "PNG");
}

}  // namespace

void save_figure(const TimeChart& chart, const QString& file) {
    const std::unique_ptr<TimeChart> paper = chart.on_paper();
    QByteArray bytes;
    QBuffer to(&bytes);
    to.open(QIODevice::WriteOnly);
    if (file.endsWith(".svg")) {
        draw_svg(*paper, to);
    } else if (file.endsWith(".pdf")) {
        draw_pdf(*paper, to);
    } else if (file.endsWith(".png")) {
        draw_png(*paper, to);
    } else {
        throw Error({file.toStdString(), 0}, "", "has a name that says no kind of figure",
                    "End it with .svg, .pdf, .png or .csv.");
    }
    to.close();
    replace_file(file, bytes);
}

Table table_of_curves(recording::LogBrowser& log, std::vector<task::RecordedValue>& values,
                      const QStringList& names, double begin, double end) {
    Table out;
    out.columns.push_back({"time_s", "time of the tick", "s"});
    for (size_t i = 0; i < values.size(); ++i) {
        const std::string name = names[static_cast<qsizetype>(i)].toStdString();
        out.columns.push_back(
            {analysis::column_name(name, values[i].unit()), name, values[i].unit()});
    }
    const frame::Frame* frame = &log.at(begin);
    for (; frame != nullptr && seconds(frame->time) <= end; frame = log.next()) {
        std::vector<Table::Cell>& row = out.rows.emplace_back();
        row.emplace_back(seconds(frame->time));
        for (task::RecordedValue& value : values) row.emplace_back(value(*frame));
    }
    return out;
}

}  // namespace dihaptic::gui
