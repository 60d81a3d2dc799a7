# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -D SOURCE=... -D LIBRARY_PAGE=... -D OUT=... -D VERSION=... -P html.cmake: writes the manual as a folder of
# linked pages with an index. Links to other pages lead to the site of mandoc's manual.
get_filename_component(OUT "${OUT}" ABSOLUTE)
get_filename_component(SOURCE "${SOURCE}" ABSOLUTE)
find_program(MANDOC mandoc REQUIRED)
file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT})
set(sections 7 1 5 3)
set(titles Overview Tools Formats Library)
set(style "body { max-width: 52em; margin: 1em auto; padding: 0 1em; font-family: sans-serif; line-height: 1.4 }
table.head, table.foot { width: 100% }
td.head-rtitle, td.foot-os { text-align: right }
td.head-vol { text-align: center }
div.Bd-indent { margin-left: 3em }
pre, code { font-family: monospace }
pre { overflow-x: auto }
dd { margin-left: 3em }
table.Bl-column td { vertical-align: top; padding-right: 1em }
img { max-width: 100% }
a.permalink { color: inherit; text-decoration: none }
")
file(WRITE ${OUT}/style.css "${style}")

set(body "")
foreach(section title IN ZIP_LISTS sections titles)
    string(APPEND body "<h2>${title}</h2>\n<dl>\n")
    file(GLOB names RELATIVE ${SOURCE}/man ${SOURCE}/man/*.${section})
    if(section EQUAL 3)
        set(names libcontact.3)
    endif()
    list(TRANSFORM names REPLACE "\\.${section}$" "") # contact comes before contact-theory
    list(SORT names)
    foreach(name IN LISTS names)
        set(file ${name}.${section})
        set(page ${SOURCE}/man/${file})
        if(section EQUAL 3)
            set(page ${LIBRARY_PAGE})
        endif()
        execute_process(COMMAND ${MANDOC} -Thtml
            "-Ostyle=style.css,man=%N.%S.html\\;https://man.openbsd.org/%N.%S" ${page}
            WORKING_DIRECTORY ${SOURCE}/man # where mandoc searches for the pages of this manual
            OUTPUT_FILE ${OUT}/${file}.html COMMAND_ERROR_IS_FATAL ANY)
        # Shows a picture that a page names, above its caption.
        file(STRINGS ${page} pictures REGEX "^\\.Lk [^ ]*\\.png ")
        if(pictures)
            file(READ ${OUT}/${file}.html text)
            string(REGEX REPLACE "<a class=\"Lk\" href=\"([^\"]*\\.png)\">([^<]*)</a>"
                "<img src=\"\\1\" alt=\"\\2\"><br><i>\\2</i>" text "${text}")
            file(WRITE ${OUT}/${file}.html "${text}")
            foreach(line IN LISTS pictures)
                string(REGEX REPLACE "^\\.Lk ([^ ]*) .*" "\\1" picture "${line}")
                file(COPY ${SOURCE}/sample_surfaces/${picture} DESTINATION ${OUT})
            endforeach()
        endif()
        file(STRINGS ${page} what REGEX "^\\.Nd " LIMIT_COUNT 1)
        string(REGEX REPLACE "^\\.Nd " "" what "${what}")
        string(APPEND body "<dt><a href=\"${file}.html\">${name}(${section})</a></dt>\n<dd>${what}</dd>\n")
    endforeach()
    string(APPEND body "</dl>\n")
endforeach()
file(WRITE ${OUT}/index.html "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<link rel=\"stylesheet\" href=\"style.css\">
<title>libcontact ${VERSION}: the manual</title>
</head>
<body>
<h1>libcontact ${VERSION}: the manual</h1>
${body}</body>
</html>
")
