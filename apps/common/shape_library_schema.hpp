#pragma once

namespace shape3d::apps {

class Sqlite;

/// Version of the layout of tables.
inline constexpr int kLibraryVersion = 1;

/// Makes the tables of an empty shape library in an empty database, in one transaction.
void make_schema(const Sqlite& database);

/// @throws FileError  the database is no shape library, or of another version.
void check_schema(const Sqlite& database);

/// Settings of a connection that writes.
void prepare_to_write(const Sqlite& database);

}  // namespace shape3d::apps
