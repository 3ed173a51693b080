// SPDX-License-Identifier: GPL-3.0-or-later
// What the plugin offers, apart from the interface of the host: one filter per feature of the library, then custom rules,
// limit surface, deviation and opening files.
#pragma once

#include "host.hpp"

#include <QJsonArray>

#include <string>

class Filters {
public:
    // Asks the library for its features; there are none where it cannot tell.
    Filters();

    // Filters are numbered from 0.
    int count() const;
    QString name(int id) const;
    // What the filter does, as HTML.
    QString info(int id) const;
    // What the filter works on: the current layer, two layers, none.
    enum Kind { Changes, Measures, Opens };
    Kind kind(int id) const;

    void parameters(int id, MeshDocument const& document, RichParameterList& list) const;
    // Runs a filter on the current layer and gives the lines for the log. Throws std::exception with a message for the user;
    // the document is as it was before then.
    std::string apply(int id, RichParameterList const& parameters, MeshDocument& document, vcg::CallBackPos* progress) const;

private:
    QJsonArray features_;  // What welt_feature_list gives.
};
